// SPDX-License-Identifier: Apache-2.0
// make_seeds DIR writes DIR/NAME/NAME, a small valid file for each fuzzed reader, and further ones with several parts,
// bands or other separators. It also writes those of all readers of sources to DIR/source.
#include <filesystem>

#include <burnish/book/book_file.h>
#include <burnish/file.h>
#include <burnish/testing/books.h>
#include <burnish/testing/btf.h>
#include <burnish/testing/checkpoints.h>
#include <burnish/testing/seed_files.h>

namespace {

/// Returns the text with each `from` replaced by `to`.
std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

/// Returns a Klems file or tensor tree with each of its blocks for all four parts, in this band too.
std::string with_all_parts(const std::string& xml, const std::string& band) {
  const std::size_t begin = xml.find("<WavelengthData>"), end = xml.find("</Layer>");
  const std::string block = xml.substr(begin, end - begin);
  std::string blocks = replaced(block, "Visible", band);
  for (const char* part : {"Reflection Front", "Reflection Back", "Transmission Front", "transmission back"})
    blocks += replaced(block, "Reflection Front", part);
  return xml.substr(0, begin) + blocks + xml.substr(end);
}

/// Returns a Speos file of reflection and transmission, whose thetas count from 90 degrees.
std::string speos_of_two_parts() {
  const auto block = [](int least) {
    std::string text = "20\n2 2\n\t0\t180\n";
    for (const int theta : {least, least + 90}) text += std::to_string(theta) + "\t0.06\t0.07\n";
    return text;
  };
  return "OPTIS - brdf surface file v8.0\n0\nseed\n5\nnone\n1\t1\n1\n2\t1\n0 60\n550\n" + block(0) +
         block(0) + block(90) + block(90) + "End of file\n";
}

/// Returns a Zemax file of this type with the bands of colour.
std::string colour_zemax(const std::string& type) {
  using burnish::seeds::kZemax;
  const std::size_t begin = kZemax.find("Monochrome\nDataBegin");
  const std::string block = kZemax.substr(begin);
  std::string text = replaced(replaced(kZemax.substr(0, begin), "Monochrome", "XYZ"), "BRDF", type);
  for (const char* band : {"TristimulusX", "TristimulusY", "TristimulusZ"})
    text += replaced(block, "Monochrome", band);
  return text;
}

std::string lobes_checkpoint() {
  burnish::LobesCheckpoint checkpoint;
  checkpoint.key = 7;
  checkpoint.rounds = 2;
  checkpoint.log_values = {{0.5, -1}, {2}};
  checkpoint.fits.weights = {1, 0};
  checkpoint.fits.trust = {0.5f};
  checkpoint.normals_of_all = {0.1f, 0};
  return burnish::format_checkpoint(checkpoint);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  const auto write = [&](const std::string& folder, const std::string& name, const std::string& bytes) {
    std::filesystem::create_directories(std::filesystem::path(argv[1]) / folder);
    burnish::write_then_rename(std::filesystem::path(argv[1]) / folder / name, bytes);
  };
  for (const auto& [name, bytes] : burnish::seeds::all_seeds()) {
    write(name, name, bytes);
    write("source", name, bytes);
  }
  for (const std::string folder : {"rgl", "source"})
    write(folder, "rgl-spectral", burnish::seeds::spectral_rgl_seed());
  for (const std::string folder : {"tensortree", "source"})
    write(folder, "tensortree4", burnish::seeds::kTensorTree4);
  const auto write_source = [&](const std::string& folder, const std::string& name,
                                const std::string& bytes) {
    write(folder, name, bytes);
    write("source", name, bytes);
  };
  using burnish::seeds::kAstm, burnish::seeds::kCsv, burnish::seeds::kKlems, burnish::seeds::kTensorTree,
      burnish::seeds::kZemax, burnish::seeds::mbsdf_seed;
  write_source("klems", "klems-parts", with_all_parts(kKlems, "Solar"));
  write_source("klems", "klems-x", "a line before\n" + with_all_parts(kKlems, "CIE-X"));
  write_source("tensortree", "tensortree-parts", with_all_parts(kTensorTree, "NIR"));
  write_source("speos", "speos-parts", speos_of_two_parts());
  write_source("zemax", "zemax-btdf", replaced(kZemax, "BRDF", "BTDF"));
  write_source("zemax", "zemax-colour", colour_zemax("BRDF"));
  write_source("mbsdf", "mbsdf-plain", replaced(mbsdf_seed(), "MBSDF_DATA_REFLECTION=", "MBSDF_DATA="));
  write_source("csv", "csv-tabs", replaced(replaced(kCsv, ",", "\t"), "\n", "\r"));
  write_source("csv", "csv-plane",
               "Theta_I;theta_v;Value_450;note\n10,5;-30;0,1;a\n10,5;0;0,2;b\n10,5;30;0,3;c\n");
  write_source("csv", "csv-view", "theta_i,phi_i,theta_v,phi_v,CCBRDF\n60,0,0,0,.1\n20,0,0,0,.2\n");
  write_source("astm", "astm-brf",
               replaced(replaced(replaced(kAstm, "R,G,B", "BRF"), ",1,2,3", ",1"), ",4,5,6", ",4"));
  write("ssdd", "ssdd-binary", burnish::seeds::binary_ssdd_seed());
  write("illuminant", "illuminant", burnish::seeds::kIlluminant);
  write("surface", "surface", burnish::seeds::surface_seed());
  write("surface", "surface-exr", burnish::seeds::surface_exr_seed());
  write("checkpoint", "weights", burnish::format_checkpoint(burnish::some_checkpoint(true)));
  write("checkpoint", "lobes", lobes_checkpoint());
  write("book", "book", burnish::format_book(burnish::random_book()));
  write("capture", "capture", burnish::seeds::kCapture);
  write("csv", "texels", burnish::seeds::kTexelCsv);
  write("csv", "gonio", burnish::seeds::kGonioCsv);
  write("btf", "btf", burnish::btf_bytes(burnish::btf_content()));
  write("utia", "utia", burnish::seeds::kUtia);
  write("np", "np", burnish::seeds::kNpCode);
  write("directions", "directions", burnish::seeds::kDirections);
  return 0;
}
