// SPDX-License-Identifier: Apache-2.0
#pragma once

// A small valid file of every format, for tests of bad input and for the fuzzers.

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <burnish/baselines/baseline_file.h>
#include <burnish/baselines/neural_brdf.h>
#include <burnish/factors/compact_file.h>
#include <burnish/factors/model_file.h>
#include <burnish/io/rgl.h>
#include <burnish/reflectance/analytic.h>
#include <burnish/reflectance/rgl_builder.h>
#include <burnish/surface/surface_file.h>

namespace burnish::seeds {

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(value));
}

inline std::string merl_seed() {
  std::string bytes;
  for (int axis = 0; axis < 3; ++axis) append(bytes, std::int32_t{2});
  for (int i = 0; i < 24; ++i) append(bytes, i % 5 == 4 ? -1.0 : 100.0 * i);
  return bytes;
}

inline std::string mbsdf_seed() {
  std::string bytes = "NVIDIA ARC MBSDF V1\nname=\"seed\"\n";
  for (const char* part : {"MBSDF_DATA_TRANSMISSION=\n", "MBSDF_DATA_REFLECTION=\n"}) {
    bytes += part;
    for (const std::uint32_t word : {1u, 2u, 2u}) append(bytes, word);
    for (int i = 0; i < 24; ++i) append(bytes, 0.1f * static_cast<float>(i) - 0.2f);
  }
  return bytes;
}

/// Returns a Fourier BSDF of these cosines. `series_of(mu_i, mu_o)` returns the coefficients of a pair, channel
/// after channel.
inline std::string fourier_bytes(const std::vector<float>& mu, std::uint32_t channels,
                                 std::vector<float> (*series_of)(float mu_i, float mu_o),
                                 const std::string& remarks = "") {
  std::string table, coefficients;
  std::uint32_t count = 0, longest = 0;
  for (const float mu_o : mu)
    for (const float mu_i : mu) {
      const std::vector<float> series = series_of(mu_i, mu_o);
      const auto length = static_cast<std::uint32_t>(series.size()) / channels;
      append(table, count);
      append(table, length);
      for (const float a : series) append(coefficients, a);
      count += length * channels;
      longest = length > longest ? length : longest;
    }
  std::string bytes = "SCATFUN\x01";
  const auto size = static_cast<std::uint32_t>(mu.size());
  for (const std::uint32_t word :
       {1u, size, count, longest, channels, 1u, static_cast<std::uint32_t>(remarks.size()), 0u, 0u})
    append(bytes, word);
  for (const float word : {1.5f, 0.1f, 0.1f, 0.f, 0.f}) append(bytes, word);
  for (const float m : mu) append(bytes, m);
  bytes.append(4 * mu.size() * mu.size(), '\0');
  return bytes + table + coefficients + remarks;
}

inline std::string fourier_seed() {
  return fourier_bytes({-1, 0, 0, 1}, 1, [](float mu_i, float mu_o) {
    return mu_i < 0 && mu_o > 0 ? std::vector<float>{0.3f, 0.1f, -0.05f} : std::vector<float>{};
  });
}

inline std::string rgl_seed() {
  burnish::RglOptions options;
  options.theta_i_count = 2;
  options.ndf_theta = options.ndf_phi = options.resolution = 4;
  return burnish::format_rgl(burnish::make_rgl_table(burnish::parse_analytic("ggx").ref(), options));
}

/// Returns an RGL file of three wavelengths.
inline std::string spectral_rgl_seed() {
  burnish::RglOptions options;
  options.theta_i_count = 2;
  options.ndf_theta = options.ndf_phi = options.resolution = 4;
  options.lambda_nm = {450, 550, 650};
  return burnish::format_rgl(
      burnish::make_rgl_table(burnish::parse_analytic("ggx:f0=0.8/0.4/0.2").ref(), options));
}

/// Returns a model of a line and a disk.
inline burnish::Model small_model() {
  using namespace burnish;
  const Table p{
      .name = "p", .layout = {.width = 2}, .channels = 1, .values = {1, 0.2f}, .format = TableFormat::unorm8};
  const Table q{
      .name = "q",
      .layout = {.shape = TableShape::disk, .width = 2, .height = 2, .warp = {WarpKind::rational, 0.5}},
      .channels = 3,
      .values = std::vector<float>(12, 1.0f),
      .format = TableFormat::rgb9e5};
  const Lobe lobe{.scale = {0.1, 0.2, 0.3},
                  .factors = {{.table = 0, .projection = kProjectWi},
                              {.table = 0, .projection = kProjectWo},
                              {.table = 1, .projection = kProjectHalf}}};
  return {.brdf = FactoredBrdf(3, {p, q}, {lobe})};
}

inline std::string model_seed() {
  return burnish::format_model(small_model());
}

inline std::string compact_seed() {
  using namespace burnish;
  const Model small = small_model();
  std::vector<Table> tables(small.brdf.tables().begin(), small.brdf.tables().end());
  std::vector<Lobe> lobes(small.brdf.lobes().begin(), small.brdf.lobes().end());
  tables.push_back(
      {.name = "g",
       .layout = {.shape = TableShape::grid, .width = 2, .height = 3, .warp = {WarpKind::power, 0.8}},
       .channels = 1,
       .values = {1, 0.5f, 0.25f, 1, 0.5f, 0.25f},
       .format = TableFormat::half});
  lobes.push_back({.scale = {1, 0x1p-20, 1e30},
                   .factors = {{.table = 2, .projection = kProjectHalf, .projection_y = kProjectAzimuth},
                               {.table = 1, .projection = {.wi = 1, .mirror = -0.5, .n = 0.3}}}});
  return format_compact({.brdf = FactoredBrdf(3, std::move(tables), std::move(lobes)),
                         .lambda_nm = {450, 550.5, 650},
                         .notes = R"({"a":[1]})"},
                        CompactContent::model_and_notes);
}

/// Returns a single neural encoding, of weights with few digits.
inline std::string neural_seed() {
  std::string row = "seed";
  for (std::size_t i = 0; i < burnish::NeuralBrdf::kWeights; ++i)
    row += "," + std::to_string(static_cast<int>(i * i % 7) - 3) + "e-1";
  return row + "\n";
}

inline std::string baseline_seed() {
  using namespace burnish;
  using enum PairCoordinate;
  NodeTable u{{{theta_h, 2}}, 3, 1, {1, 0.5f, 2, -1, 0, 4}},
      v{{{theta_d, 2}, {phi_d, 2}}, 1, 1, {1, 2, 3, 4}};
  return format_baseline(
      {.kind = "svd", .brdf = SeparableBrdf(std::move(u), std::move(v), {1, 2, 3}), .notes = R"({"a":1})"});
}

/// A code of Neural Processes, which is a BRDF only with its decoder.
inline const std::string kNpCode = "seed,0.5,-0.25,1e-1,1.5,-.75,0,2\n";
inline const std::string kCornell =
    "# Maker\n# Paint\n2\n400 500\n0.5 0 0.25 3.14 0.1 0.2\n0.5 0 0.75 0 -0.1 0.4\n";
inline const std::string kAstm =
    "SAMPLE steel\nNUM_POINTS 2\nVARS "
    "theta_i,phi_i,theta_s,phi_s,R,G,B\n.1,.2,.3,.4,1,2,3\n.1,.5,.3,.4,4,5,6\n";
inline const std::string kCsv =
    "# isotropic\ntheta_i,phi_i,theta_o,phi_o,r,g,b\n30,0,60,180,1,2,3\n10,5,20,30,0.1,-0.2,0.3\n";
/// A table as spreadsheets write it, with remarks and columns of unknown names.
inline const std::string kGonioCsv =
    "BRF Values\n\"Theta_i "
    "[deg]\";\"Phi_i\";theta_r;phi_r;450nm;550nm;remark\n30;0;60,5;180;0,1;0,2;\"a;b\"\n"
    "30;0;-60,5;180;nan;0,2;\n30;0;0;0;0,3;0,2;c\n";
inline const std::string kFred =
    "type bsdf_data\nformat angles=deg bsdf=value "
    "scale=2\n30\t0\n30\t0\t0.5\n60\t90\t0.1\n45\t0\n0\t0\t-0.2\n";
inline const std::string kTexelCsv =
    "texel_x,texel_y,wi_x,wi_y,wi_z,wo_x,wo_y,wo_z,held_out,r,g,b\n0,0,0,0,1,0.6,0,0.8,0,1,2,3\n"
    "1,0,0,0.6,0.8,0,0,1,1,.1,.2,.3\n1,0,0,0,1,0,0,1,0,4,5,6\n";
inline const std::string kDirections = "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,1,0.6,0,0.8\n0,0.6,-0.8,1,0,0\n";
inline const std::string kZemax =
    "# Sample: "
    "paint\nSource\tMeasured\nSymmetry\tPlaneSymmetrical\nSpectralContent\tMonochrome\nScatterType\tBRDF\n"
    "SampleRotation\t1\n0\nAngleOfIncidence\t2\n10 30\nScatterAzimuth\t3\n0 90 180\nScatterRadial\t2\n0 "
    "10\n\n"
    "Monochrome\nDataBegin\nTIS 0.1\n1 2\n1 3\n1 4\nTIS 0.2\n5 6\n5 -7\n5 0.000e+00\nDataEnd\n";
inline const std::string kKlems =
    "<WindowElement><Optical><Layer><DataDefinition><IncidentDataStructure>Columns</"
    "IncidentDataStructure><AngleBasis>"
    "<AngleBasisName>B</AngleBasisName><AngleBasisBlock><nPhis>1</nPhis><ThetaBounds><LowerTheta>0</"
    "LowerTheta>"
    "<UpperTheta>30</UpperTheta></ThetaBounds></AngleBasisBlock><AngleBasisBlock><nPhis>2</"
    "nPhis><ThetaBounds>"
    "<LowerTheta>30</LowerTheta><UpperTheta>90</UpperTheta></ThetaBounds></AngleBasisBlock></AngleBasis></"
    "DataDefinition>"
    "<WavelengthData><Wavelength>Visible</"
    "Wavelength><WavelengthDataBlock><WavelengthDataDirection>Reflection Front"
    "</WavelengthDataDirection><ColumnAngleBasis>B</ColumnAngleBasis><RowAngleBasis>B</"
    "RowAngleBasis><ScatteringData>"
    "1, 2, 3\n4 5 6\n7 8 "
    "-9</ScatteringData></WavelengthDataBlock></WavelengthData></Layer></Optical></WindowElement>";

inline const std::string kOpenMaterial =
    R"({"metadata":{"name":"seed","license":"CC0","authors":["nobody"]},"brdf":{"wavelengths":[4e-07,6e-07],)"
    R"("lookupTable":[[4e-07,0.5,0.25,0,0.1],[4e-07,0.5,0.25,3.1,0.2],[6e-07,0.5,0.25,0,0.3],)"
    R"([6e-07,0.5,0.25,3.1,0.4]]}})";
inline const std::string kAlta =
    "#SAMPLE \"seed\"\n#ORIGIN \"nowhere\"\n#DIM 3 1\n#VS 1\n#PARAM_IN ISOTROPIC_TL_TV_PROJ_DPHI\n#PARAM_OUT "
    "INV_STERADIAN\n0.5 -0.3 0.1 0.25 0.01\n0.5 0.6 0 -0.1 0.01\n0.7 0.2 0.2 0.5 0.01\n";
inline const std::string kSpeos =
    "OPTIS - Anisotropic BSDF surface file v8.0\n0\nseed\n4\nnone\n1\t0\t0\n1\t0\n0\n2\n0 90\n1\n30\n1\n30\n"
    "30\t0\nspectrum\n2\n450\t20\n650\t40\n2 3\n\t0\t120\t240\n0\t1\t1\t1\n60\t0.4\t0.5\t0.6\n"
    "2 3\n\t0\t120\t240\n0\t1\t1\t1\n60\t0.4\t-0.5\t0.6\nEnd of file\n";
/// A LightTools BSDF of two incidences, of reflection on the front and transmission on the back.
inline const std::string kLightTools =
    "# seed\nSymmetry PlaneSymmetrical\nSpectralContent Monochrome\nScatterAzimuth 3\n90 180 270\n"
    "ScatterRadial 2\n0 60\nDataBegin\nAOI 0\nPOI 0\nSide Front\nWavelength 550\nScatterType BRDF\nTIS 0.3\n"
    "0.1 0.2\n0.1 0.3\n0.1 0.4\nAOI 30\nPOI 0\nSide Front\nWavelength 550\nScatterType BRDF\nTIS 0.3\n"
    "0.1 0.2\n0.1 -0.3\n0.1 0.5\nAOI 180\nPOI 0\nSide Back\nWavelength 550\nScatterType BTDF\nTIS 0.2\n"
    "0.2 0.1\n0.2 0.1\n0.2 0.1\nDataEnd\n";
inline const std::string kIntegra =
    ";; seed\nSource Measured\nTypeSym PlaneSymmetrical\nTypeColorModel RGB\nTypeData Luminance Absolute\n"
    "sigma 2\n 0 45\nsigmat\n 0 28\nphi 2\n 0 180\ntheta 3\n 0 10 90\nred\n kbdf\n 1 0.5\n def\n"
    " 3 2 1\n 3 2 .5\n;; sigma = 45\n 6 2 1\n 6 1 0\n enddef\ngre\n def\n 1 1 1 1 1 1 1 1 1 1 1 -1\n enddef\n"
    "blue\n def\n 2 2 2 2 2 2 2 2 2 2 2 2\n enddef\n";
inline const std::string kSsdd =
    "VERSION 0.3\nSOFTWARE seed\n\n# paint\nDATA_TYPE brdf\nCOLOR_MODEL spectrum\nWAVELENGTH_LIST 450 550 "
    "650\n"
    "PARAM_TYPE half_difference_coordinate_system\nREDUCTION_TYPE bilateral_symmetry reciprocity\n"
    "PARAM0_LIST 0 90\nPARAM2_LIST 0 90\nPARAM3_LIST 0 90\nNAME seed\nDATA ascii\n# PARAM3: 0\n1 2 3\n"
    ".1 .2 .3\n1 2 3\n.1 .2 .3\n1 2 3\n.1 .2 -.3\n1 2 3\n.1 .2 .3\n\nDATA_TYPE specular_reflectance\n"
    "COLOR_MODEL monochrome\nPARAM0_LIST 0 90\nDATA ascii\n0.05\n0.5\n";
/// Returns an SSDD file of binary values in specular coordinates.
inline std::string binary_ssdd_seed() {
  std::string bytes =
      "VERSION 0.2\nDATA_TYPE btdf\nCOLOR_MODEL xyz\nPARAM_TYPE specular_coordinate_system\n"
      "PARAM0_LIST 0 45\nPARAM2_LIST 0 20 180\nPARAM3_LIST 0 180 360\nPARAM4_LIST 0 -17\nDATA binary\n";
  for (int k = 0; k < 3 * 2 * 3 * 3; ++k) append(bytes, 0.1f * static_cast<float>(k % 7));
  return bytes;
}
inline const std::string kSpeosScattering =
    "OPTIS - Simple scattering surface file v2.0\nseed\nBoth\n\n10 20 40 30 50\n4 8\n0\n60\n";
inline const std::string kTensorTree =
    "<WindowElement><Optical><Layer><DataDefinition><IncidentDataStructure>TensorTree3</"
    "IncidentDataStructure>"
    "</DataDefinition><WavelengthData><Wavelength>Visible</Wavelength><WavelengthDataBlock>"
    "<WavelengthDataDirection>Reflection "
    "Front</WavelengthDataDirection><AngleBasis>LBNL/Shirley-Chiu</AngleBasis>"
    "<ScatteringData>{ { 1 2 3 4 5 6 7 8 } {.5} {-1} {0} {{1}{2}{3}{4}{5}{6}{7}{8}} {0} {2e-1} {0} "
    "}</ScatteringData>"
    "</WavelengthDataBlock></WavelengthData></Layer></Optical></WindowElement>";

/// A tensor tree of rank 4: sixteen cells, the first divided again.
inline const std::string kTensorTree4 =
    "<WindowElement><Optical><Layer><DataDefinition><IncidentDataStructure>TensorTree4</"
    "IncidentDataStructure>"
    "</DataDefinition><WavelengthData><Wavelength>Visible</Wavelength><WavelengthDataBlock>"
    "<WavelengthDataDirection>Reflection "
    "Front</WavelengthDataDirection><AngleBasis>LBNL/Shirley-Chiu</AngleBasis>"
    "<ScatteringData>{ { 1 2 3 4 5 6 7 8 9 10 11 12 13 14 15 16 } {.5} {-1} {0} {1} {2} {3} {4} {5} {6} {7} "
    "{8} {9} {10} {2e-1} {0} }</ScatteringData>"
    "</WavelengthDataBlock></WavelengthData></Layer></Optical></WindowElement>";

inline const std::string kIlluminant = "# a lamp\n400 0.5\n550\t1\n\n700.5 2e3\n";

/// Bytes of a number, which repeated are a UTIA table of it.
inline const std::string kUtia{"\x9a\x99\x99\x99\x99\x99\xf1\x3f", 8};

/// Returns a surface of the small model, with normals.
inline burnish::SurfaceModel small_surface() {
  using namespace burnish;
  const std::vector<float> weights{0, 1, 0.5f, 0.25f, 1, 0},
      normals{0, 0, 0.1f, 0, 0, 0.5f, -0.5f, 0, 0.1f, 0.2f, 0, 0};
  SurfaceMaps maps{.weights = {SurfaceMap(3, 2, 1, TableFormat::unorm8, 1, weights)},
                   .normals = SurfaceMap(3, 2, 2, TableFormat::half, 1, normals),
                   .tangents = {}};
  return {.brdf = SpatialBrdf(small_model().brdf, std::move(maps)), .notes = "{}"};
}
inline std::string surface_seed() {
  return burnish::format_surface(small_surface());
}
inline std::string surface_exr_seed() {
  return burnish::format_surface_exr(small_surface());
}

inline const std::string kCapture =
    R"({"version":1,"width":4,"height":3,"size":[0.2,0.15],"transfer":"srgb","clip":0.99,"normals":"n.exr","pictures":[)"
    R"({"file":"a.png","light":{"direction":[0,0.6,0.8]},"view":{"position":[0,0,2.5]},"scale":[1,2,3],"mask":"m.png"},)"
    R"({"file":"b.png","light":{"position":[1,0,3]},"view":{"direction":[0,0,1]},"scale":0.5,"held_out":true}]})";

/// Returns a small file of each format that is read. Tests cut and bend them, and fuzzers start from them. The page's
/// tests open them, and find a new one under the first word of its title (Format), in small letters.
inline std::vector<std::pair<std::string, std::string>> all_seeds() {
  return {{"merl", merl_seed()},
          {"mbsdf", mbsdf_seed()},
          {"rgl", rgl_seed()},
          {"model", model_seed()},
          {"compact", compact_seed()},
          {"fourier", fourier_seed()},
          {"cornell", kCornell},
          {"astm", kAstm},
          {"csv", kCsv},
          {"gonio", kGonioCsv},
          {"fred", kFred},
          {"zemax", kZemax},
          {"klems", kKlems},
          {"openmaterial", kOpenMaterial},
          {"alta", kAlta},
          {"speos", kSpeos},
          {"simple", kSpeosScattering},
          {"lighttools", kLightTools},
          {"integra", kIntegra},
          {"ssdd", kSsdd},
          {"ssdd_binary", binary_ssdd_seed()},
          {"tensortree", kTensorTree},
          {"neural", neural_seed()},
          {"baseline", baseline_seed()}};
}

}  // namespace burnish::seeds
