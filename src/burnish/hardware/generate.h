// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <burnish/power/fixed_point.h>
#include <burnish/power/fixed_point_blinn.h>

namespace burnish {

/// A configuration that is generated, proved and reported under a name.
struct ShippedUnit {
  std::string_view name;
  UnitConfig config;
};
std::span<const ShippedUnit> shipped_units();
/// Throws Error naming the shipped units.
const ShippedUnit& shipped_unit(std::string_view name);

struct GeneratedFile {
  std::string name, text;
};

/// One input of a unit and what it must answer.
struct UnitVector {
  std::uint32_t exponent, input, value;
};

/// Seeded vectors: the corners c = 0 and c = 1 of several exponents first, then half of them uniform, half in
/// the highlight, where e (1 - c) is below 12.
std::vector<UnitVector> golden_vectors(const SpecularUnit& unit, int count, std::uint64_t seed = 1);

/// Everything a simulator or synthesizer needs, in one folder: module NAME (ports only, all parameters set),
/// the modules below it, its table images NAME_*.mem, a self-checking test bench NAME_tb.sv with its vectors
/// NAME_golden.mem, and NAME.f, the list of files to compile. Throws Error if the name is no identifier.
std::vector<GeneratedFile> generate_unit(const SpecularUnit& unit, const std::string& name,
                                         int vectors = 2000);

/// The same for Blinn's front end (power/fixed_point_blinn.h) feeding the exact unit: vectors in, value out.
/// `unit` takes versines. Throws Error if it does not, or is another unit.
std::vector<GeneratedFile> generate_blinn(const SpecularUnit& unit, const std::string& name,
                                          int vectors = 2000);

/// The inputs of the front end and the outputs of the unit behind it.
struct BlinnVector {
  FixedVec3 normal, light, view;
  std::uint32_t exponent, value;
};

/// Seeded vectors: unit lights and views, normals of length 1/2 to 1, half of them in the highlight, after
/// the corners: equal directions, opposite ones, zero, backs and the largest words.
std::vector<BlinnVector> blinn_vectors(const SpecularUnit& unit, int count, std::uint64_t seed = 1);

/// The exact unit between two AXI4-Streams (hw/rtl/burnish_exact_axis.sv): module NAME, the modules below it, its table
/// images, NAME.f, golden vectors, and NAME.xml, which describes ports, streams and files as an IP-XACT component
/// (IEEE 1685-2022). Throws Error if `unit` is another unit.
std::vector<GeneratedFile> generate_axis(const SpecularUnit& unit, const std::string& name,
                                         int vectors = 2000);

/// Module `bench`, all of `names` side by side with ports in arrays, for a test bench in C++.
GeneratedFile generate_bench(std::span<const std::string> names, std::span<const SpecularUnit> units);

/// The modules of hw/rtl as files.
std::vector<GeneratedFile> rtl_modules();

}  // namespace burnish
