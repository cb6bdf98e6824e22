// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include <burnish/reflectance/analytic/ashikhmin_premoze_shirley.h>
#include <burnish/reflectance/analytic/cosine_lobes.h>
#include <burnish/reflectance/analytic/diffuse.h>
#include <burnish/reflectance/analytic/microfacet.h>
#include <burnish/reflectance/analytic/openpbr.h>
#include <burnish/reflectance/analytic/poulin_fournier.h>
#include <burnish/reflectance/analytic/ward.h>
#include <burnish/reflectance/brdf.h>

namespace burnish {

/// A parameter of an analytic model, as help and `info` print it.
struct AnalyticParameter {
  std::string_view name, description;
  double min, max;       ///< both allowed
  double default_value;  ///< of every channel
  bool color = false;    ///< may differ between the channels
};

using AnalyticVariant = std::variant<Lambert, OrenNayar, Phong, BlinnPhong, Lafortune, Ward, CookTorrance,
                                     AshikhminShirley, Ggx, Beckmann, PoulinFournier, Satin, OpenPbr>;

/// A model that has a name.
struct AnalyticModel {
  std::string_view name, description;
  std::span<const AnalyticParameter> parameters;
  bool conserving;  ///< directional albedo <= 1 where kd, or kd + ks if it has ks, leaves room
  /// Builds it from one value a parameter, in order, each within its range.
  AnalyticVariant (*build)(std::span<const Rgb> values);
  bool reciprocal = true;  ///< f(wi, wo) = f(wo, wi)
};

/// All models, in the order help lists them.
std::span<const AnalyticModel> analytic_models();

/// An analytic BRDF: a model with its parameters. Channels: 3.
class AnalyticBrdf {
 public:
  /// `values`: one a parameter of the model, in order. Throws Error naming model, parameter, range and value
  /// where one is outside its range, or where channels differ in a parameter that is no colour.
  AnalyticBrdf(const AnalyticModel& model, std::vector<Rgb> values);

  static constexpr std::size_t channels() noexcept { return 3; }
  bool isotropic() const noexcept;
  bool eval(Vec3 wi, Vec3 wo, std::span<double> f) const noexcept;

  /// The model itself, chosen once, for many evaluations. Refers to this object.
  BrdfRef ref() const noexcept;

  /// 4 for each number that is not its parameter's default; a colour has three.
  std::size_t bytes() const noexcept;

  const AnalyticModel& model() const noexcept { return *model_; }
  std::span<const Rgb> values() const noexcept { return values_; }
  const AnalyticVariant& variant() const noexcept { return variant_; }

 private:
  const AnalyticModel* model_;
  std::vector<Rgb> values_;
  AnalyticVariant variant_;
};

static_assert(Brdf<AnalyticBrdf>);

/// Returns true if the text is the name of a model, or begins with one and ':'.
bool is_analytic_spec(std::string_view spec);

/// Reads "MODEL" or "MODEL:name=value,name=value,..."; parameters left out have their defaults. A value is a
/// number or, for colours, three separated by '/' (red, green, blue):
/// "ggx:alpha_x=0.1,alpha_y=0.3,f0=1/0.8/0.5". Throws Error naming the parameter, what is expected and what
/// was found.
AnalyticBrdf parse_analytic(std::string_view spec);

/// OpenPBR as an analytic BRDF. Throws Error naming an input that is outside its range.
AnalyticBrdf analytic_openpbr(const OpenPbrParameters& parameters);

/// The spec with every parameter, which parse_analytic reads back to the same values, bit for bit.
std::string format_analytic(const AnalyticBrdf& brdf);

}  // namespace burnish
