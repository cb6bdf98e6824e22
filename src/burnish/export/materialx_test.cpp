// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <string>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pugixml.hpp>

#include <burnish/error.h>
#include <burnish/export/materialx.h>
#include <burnish/testing/models.h>

namespace burnish {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr MetallicRoughness kCore{{0.8, 0.4, 0.2}, 0.5, 0.6, 0.5, true};

pugi::xml_document document_of(const ExportedFile& file) {
  pugi::xml_document document;
  EXPECT_TRUE(document.load_buffer(file.bytes.data(), file.bytes.size())) << file.bytes;
  return document;
}

TEST(MaterialX, DefinesANodeWithTheInputsThatItsCodeTakes) {
  for (const char* name : {"Pqpr", "Volumes", "RootWarps"}) {
    const std::vector<ExportedFile> files =
        materialx_files(smooth_model(model_case(name)), kCore, ShaderFilter::hardware, "paint");
    const pugi::xml_document document = document_of(files.at(0));
    const pugi::xml_node root = document.child("materialx"), definition = root.child("nodedef");
    std::string parameters = "ClosureData closureData";
    for (const pugi::xml_node input : definition.children("input")) {
      const std::string type = input.attribute("type").value();
      parameters += fmt::format(", {} {}",
                                type == "filename"  ? "sampler2D"
                                : type == "vector3" ? "vec3"
                                                    : type,
                                input.attribute("name").value());
    }
    // One texture is spelled by MaterialX's own token, which every one of its generators replaces.
    if (const std::size_t at = parameters.find("sampler2D tables");
        parameters.find("volumes") == parameters.npos)
      parameters.replace(at, 16, "$texSamplerSignature");
    std::string code = files.at(1).bytes;
    std::erase(code, '\n');
    while (code.find("  ") != code.npos) code.erase(code.find("  "), 1);
    EXPECT_THAT(code, HasSubstr("void burnish_paint_bsdf(" + parameters + ", inout BSDF bsdf)"));
    EXPECT_THAT(code, Not(HasSubstr("uniform")));
    EXPECT_STREQ(root.child("implementation").attribute("file").value(), files.at(1).name.c_str());

    // every picture that is named is there
    std::size_t pictures = 0;
    for (const pugi::xml_node input : root.child("burnish_paint_bsdf").children("input")) {
      if (std::string(input.attribute("type").value()) != "filename") continue;
      const std::string file = input.attribute("value").value();
      EXPECT_EQ(std::ranges::count(files, file, &ExportedFile::name), 1) << file;
      ++pictures;
    }
    EXPECT_EQ(files.size(), 2 + pictures);
  }
}

TEST(MaterialX, ConnectsNodesThatAreThere) {
  const FactoredBrdf brdf = smooth_model(model_case("Volumes"));
  for (const ExportedFile& file :
       {materialx_files(brdf, kCore, ShaderFilter::exact, "paint").at(0), materialx_file({}, "paint")}) {
    const pugi::xml_document document = document_of(file);
    const pugi::xml_node root = document.child("materialx");
    EXPECT_STREQ(root.find_child_by_attribute("surfacematerial", "name", "paint").attribute("type").value(),
                 "material");
    int connections = 0;
    for (const pugi::xml_node node : root.children())
      for (const pugi::xml_node input : node.children("input")) {
        if (!input.attribute("nodename")) continue;
        const pugi::xml_node source =
            root.find_child_by_attribute("name", input.attribute("nodename").value());
        EXPECT_STREQ(source.attribute("type").value(), input.attribute("type").value());
        ++connections;
      }
    EXPECT_GE(connections, 1);
  }
}

TEST(MaterialX, HoldsEveryInputOfOpenPbr) {
  OpenPbrParameters parameters;
  parameters.base_color = {0.25, 0.5, 0.125};
  parameters.coat_weight = 0.75;
  const pugi::xml_document document = document_of(materialx_file(parameters, "paint"));
  const pugi::xml_node surface = document.child("materialx").child("open_pbr_surface");
  for (const OpenPbrInput& input : kOpenPbrInputs)
    EXPECT_EQ(!surface.find_child_by_attribute("input", "name", std::string(input.name).c_str()).empty(),
              input.name != "geometry_tangent")
        << input.name;
  const auto value = [&](const char* name) {
    return surface.find_child_by_attribute("input", "name", name).attribute("value").value();
  };
  EXPECT_STREQ(value("base_color"), "0.25, 0.5, 0.125");
  EXPECT_STREQ(value("coat_weight"), "0.75");
}

// A vector there, made of the surface's own.
TEST(MaterialX, TurnsTheTangentsOfOpenPbrByNodes) {
  const pugi::xml_document document =
      document_of(materialx_file({.specular_roughness_anisotropy = 0.5, .geometry_tangent = 30}, "metal"));
  const pugi::xml_node root = document.child("materialx"), surface = root.child("open_pbr_surface");
  for (const char* name : {"geometry_tangent", "geometry_coat_tangent"})
    EXPECT_STREQ(surface.find_child_by_attribute("input", "name", name).attribute("nodename").value(),
                 "metal_tangent");
  const auto factor = [&](const char* node) {
    return root.find_child_by_attribute("multiply", "name", node)
        .find_child_by_attribute("input", "name", "in2")
        .attribute("value")
        .as_double();
  };
  EXPECT_NEAR(factor("metal_along"), std::sqrt(0.75), 1e-9);
  EXPECT_NEAR(factor("metal_across"), 0.5, 1e-9);
}

TEST(MaterialX, RefusesNamesThatAreNoIdentifiers) {
  const FactoredBrdf brdf = smooth_model(model_case("Pqpr"));
  for (const char* name : {"", "a b", "1a", "a__b", "a\"/><x"}) {
    EXPECT_THROW(materialx_file({}, name), Error) << name;
    EXPECT_THROW(materialx_files(brdf, kCore, ShaderFilter::exact, name), Error) << name;
  }
}

}  // namespace
}  // namespace burnish
