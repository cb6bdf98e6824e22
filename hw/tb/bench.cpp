// SPDX-License-Identifier: Apache-2.0
// Holds the simulated units to their C++ model, bit for bit. The module `bench` and the list of its units
// come from `burnish hw generate`.
//   bench sample COUNT UNIT...   COUNT seeded vectors a unit; values offered and taken with random pauses
//   bench all UNIT...            every exponent from 1 to 1023 with every input, pauses now and then
//   bench stream UNIT            answers `exponent input` lines of standard input
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include <verilated.h>

#include <burnish/hardware/generate.h>
#include <burnish/math/random.h>

#include "Vbench.h"

using namespace burnish;

namespace {

struct Vector {
  std::uint32_t exponent = 0, input = 0;
};

/// The vectors of one unit, one after another.
class Source {
 public:
  virtual ~Source() = default;
  virtual bool next(Vector& v) = 0;
};

class Sample final : public Source {
 public:
  Sample(const SpecularUnit& unit, int count) : vectors_(golden_vectors(unit, count, 2)) {}
  bool next(Vector& v) override {
    if (position_ == vectors_.size()) return false;
    v = {vectors_[position_].exponent, vectors_[position_].input};
    ++position_;
    return true;
  }

 private:
  std::vector<UnitVector> vectors_;
  std::size_t position_ = 0;
};

class All final : public Source {
 public:
  explicit All(const SpecularUnit& unit) : one_(1U << unit.config().cosine_bits) {}
  bool next(Vector& v) override {
    if (exponent_ > static_cast<std::uint32_t>(kUnitMaxExponent)) return false;
    v = {exponent_, input_};
    if (++input_ > one_) {
      input_ = 0;
      ++exponent_;
    }
    return true;
  }

 private:
  std::uint32_t one_, exponent_ = 1, input_ = 0;
};

class Lines final : public Source {
 public:
  bool next(Vector& v) override { return static_cast<bool>(std::cin >> v.exponent >> v.input); }
};

struct Lane {
  SpecularUnit unit;
  std::string name;
  std::unique_ptr<Source> source;
  std::deque<Vector> flying;  // taken in, not answered yet
  bool offering = false, ended = false;
  std::uint64_t given = 0;  // answers
  Vector offered;
};

[[noreturn]] void fail(const Lane& lane, const char* what, std::uint32_t expected, std::uint32_t found) {
  const Vector v = lane.flying.empty() ? lane.offered : lane.flying.front();
  std::fprintf(stderr, "FAIL %s, vector %llu (exponent %u, input %u): %s: expected %u, found %u\n",
               lane.name.c_str(), static_cast<unsigned long long>(lane.given), v.exponent, v.input, what,
               expected, found);
  std::exit(1);
}

/// Says yes with odds of 256, from seeded bits.
class Chance {
 public:
  explicit Chance(std::uint32_t odds) : odds_(odds) {}
  bool operator()() {
    if (left_ == 0) {
      bits_ = std::uint64_t{random_.next()} << 32 | random_.next();
      left_ = 8;
    }
    const bool yes = (bits_ & 255) < odds_;
    bits_ >>= 8;
    --left_;
    return yes;
  }

 private:
  std::uint32_t odds_;
  Pcg32 random_{7};
  std::uint64_t bits_ = 0;
  int left_ = 0;
};

std::vector<Lane> make_lanes(const std::string& mode, int argc, char** argv) {
  std::vector<Lane> lanes;
  for (int i = mode == "sample" ? 3 : 2; i < argc; ++i) {
    SpecularUnit unit(shipped_unit(argv[i]).config);
    std::unique_ptr<Source> source;
    if (mode == "sample")
      source = std::make_unique<Sample>(unit, std::atoi(argv[2]));
    else if (mode == "all")
      source = std::make_unique<All>(unit);
    else
      source = std::make_unique<Lines>();
    lanes.push_back({unit, argv[i], std::move(source), {}, false, false, 0, {}});
  }
  return lanes;
}

void clock(Vbench& top) {
  top.clk_i = 1;
  top.eval();
  top.clk_i = 0;
  top.eval();
}

/// One clock in reset with idle inputs.
void reset(Vbench& top, std::size_t lanes) {
  top.clk_i = 0;
  top.rst_ni = 0;
  for (std::size_t i = 0; i < lanes; ++i) {
    top.valid_i[i] = 0;
    top.ready_i[i] = 0;
  }
  top.eval();
  clock(top);
  top.rst_ni = 1;
  top.eval();
}

/// Sets lane i's inputs for the next clock; true when that ends the lane: its vectors are all answered.
bool offer(Lane& lane, Vbench& top, std::size_t i, Chance& chance) {
  bool done = false;
  if (!lane.offering && !lane.ended && chance()) {
    lane.offering = lane.source->next(lane.offered);
    lane.ended = !lane.offering;
    done = lane.ended && lane.flying.empty();
  }
  top.valid_i[i] = lane.offering;
  top.exponent_i[i] = static_cast<std::uint16_t>(lane.offered.exponent);
  top.input_i[i] = lane.offered.input;
  top.ready_i[i] = chance();
  return done;
}

/// Takes lane i's answer, if there is one, and compares it; notes the vector that was taken in. True when that
/// ends the lane.
bool check(Lane& lane, const Vbench& top, std::size_t i, bool printed) {
  bool done = false;
  if (top.valid_o[i] && top.ready_i[i]) {
    if (lane.flying.empty()) fail(lane, "answers", 0, 1);
    const std::uint32_t expected = lane.unit.value(lane.flying.front().exponent, lane.flying.front().input);
    if (top.value_o[i] != expected) fail(lane, "value", expected, top.value_o[i]);
    if (printed) std::printf("%u\n", static_cast<unsigned>(top.value_o[i]));
    lane.flying.pop_front();
    ++lane.given;
    done = lane.ended && lane.flying.empty();
  }
  if (top.valid_i[i] && top.ready_o[i]) {
    lane.flying.push_back(lane.offered);
    lane.offering = false;
  }
  const auto most = static_cast<std::size_t>(lane.unit.config().depth);
  if (lane.flying.size() > most)
    fail(lane, "values in the pipeline", static_cast<std::uint32_t>(most),
         static_cast<std::uint32_t>(lane.flying.size()));
  return done;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string mode = argc > 1 ? argv[1] : "";
  if (argc <= (mode == "sample" ? 3 : 2) || (mode != "sample" && mode != "all" && mode != "stream")) {
    std::fprintf(stderr, "usage: bench sample COUNT UNIT... | all UNIT... | stream UNIT\n");
    return 2;
  }
  std::vector<Lane> lanes = make_lanes(mode, argc, argv);
  VerilatedContext context;
  Vbench top(&context);
  Chance chance(mode == "sample" ? 160 : 255);  // that a value is offered, and taken
  reset(top, lanes.size());
  for (std::size_t running = lanes.size(); running > 0;) {
    for (std::size_t i = 0; i < lanes.size(); ++i) running -= offer(lanes[i], top, i, chance);
    top.eval();
    for (std::size_t i = 0; i < lanes.size(); ++i) running -= check(lanes[i], top, i, mode == "stream");
    clock(top);
  }
  top.final();
  std::uint64_t total = 0;
  for (const Lane& lane : lanes) total += lane.given;
  if (mode != "stream")
    std::printf("PASS %llu vectors, no mismatch (%zu units)\n", static_cast<unsigned long long>(total),
                lanes.size());
  return 0;
}
