// SPDX-License-Identifier: Apache-2.0
// A program outside this repository: it runs the README's example and compares it with the definition.
#include <cmath>
#include <cstdio>
#include <vector>

#include <burnish/burnish.h>

int main() {
  // The million pairs have the light on a tilted circle and the viewer from the normal to the horizon.
  std::vector<float> wi, wo;
  for (int i = 0; i < 1'000'000; ++i) {
    const double phi = 1e-3 * i, theta = 1.5e-6 * i;
    for (const double x : {0.6 * std::cos(phi), 0.6 * std::sin(phi), 0.8})
      wi.push_back(static_cast<float>(x));
    for (const double x : {std::sin(theta), 0.0, std::cos(theta)}) wo.push_back(static_cast<float>(x));
  }

#include "readme_example.inc"  // taken from the README by install_test.cmake

  for (std::size_t i = 0; i < 3'000'000; i += 3'000) {
    double expected[3];
    fit.ref().eval({wi[i], wi[i + 1], wi[i + 2]}, {wo[i], wo[i + 1], wo[i + 2]}, expected);
    for (std::size_t c = 0; c < 3; ++c)
      if (!(std::abs(f[i + c] - expected[c]) <= evaluator.rounding_bound() * expected[c])) return 1;
  }
  std::printf("burnish evaluates a model whose file has %zu bytes\n", burnish::format_fit(fit).size());
}
