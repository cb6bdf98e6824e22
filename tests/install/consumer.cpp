// A program of somebody else's: an analytic BRDF in, the bytes of a factored one out.
#include <cstdio>

#include <burnish/eval/factored_eval.h>
#include <burnish/factors/model_file.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/half_diff_table.h>

int main() {
  const burnish::AnalyticBrdf ggx = burnish::parse_analytic("ggx:alpha_x=0.1,alpha_y=0.1");
  const burnish::HalfDiffTable table = burnish::tabulate_half_diff(ggx.ref(), 9, 9, 18, false);
  burnish::Table line{.name = "q", .layout = {.width = 2}, .channels = 1, .values = {1, 0.5f}};
  const burnish::FactoredBrdf brdf(3, {line},
                                   {{.scale = {1, 1, 1}, .factors = {{0, burnish::kProjectHalf, {}}}}},
                                   burnish::TableFormat::half);
  float f[3];
  burnish::FactoredEvaluator(brdf).eval({0, 0, 1}, {0, 0, 1}, f);
  if (f[0] != 1 || table.values.empty()) return 1;
  std::printf("burnish finds a table of %zu bytes\n", burnish::format_model({brdf, {}, "{}"}).size());
}
