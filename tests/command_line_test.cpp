// SPDX-License-Identifier: Apache-2.0
// These tests check that all verbs of the command line use the same words and rules.

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <vector>

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <burnish/file.h>
#include <burnish/io/open_source.h>
#include <burnish/math/angles.h>
#include <burnish/math/build_info.h>
#include <burnish/testing/sanitized.h>
#include <burnish/testing/seed_files.h>
#include <burnish/testing/tools.h>

namespace burnish {
namespace {

using testing::HasSubstr;

/// Runs burnish and returns its output on both streams.
Outcome burnish(const std::string& arguments) {
  return run(fmt::format("'{}' {} 2>&1", BURNISH_CLI, arguments));
}

std::string first_line(const Outcome& outcome) {
  return outcome.output.substr(0, outcome.output.find('\n'));
}

TEST(CommandLine, SaysWhatAMisspeltWordMayHaveMeant) {
  for (const auto& [arguments, meant] :
       {std::pair{"comapre a b", "'compare'"}, std::pair{"fti lambert", "'fit'"},
        std::pair{"specular tabel", "'table'"}, std::pair{"fit lambert -o x --buget 700", "'--budget'"},
        std::pair{"info lambert --jsno", "'--json'"}, std::pair{"hw generate --vectros 3", "'--vectors'"}}) {
    const Outcome outcome = burnish(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(first_line(outcome), HasSubstr(fmt::format("did you mean {}?", meant)));
  }
  // Values of options, parameters of models, and topics get suggestions too.
  for (const auto& [arguments, meant] :
       {std::pair{"export x -o y --to matrialx", "'materialx'"}, std::pair{"convert ggx a --to cvs", "'csv'"},
        std::pair{"render ggx --renderer cpuu", "'cpu'"}, std::pair{"fit ggx -o x --method nfm", "'nmf'"},
        std::pair{"info openpbr:base_colr=1", "'base_color'"}, std::pair{"info ggx:alhpa_x=1", "'alpha_x'"},
        std::pair{"help formts", "'formats'"}})
    EXPECT_THAT(first_line(burnish(arguments)), HasSubstr(fmt::format("; did you mean {}?", meant)))
        << arguments;
  for (const auto& [arguments, meant] :
       {std::pair{"specular code --method cubik2", "'cubic2'"},
        std::pair{"specular code --to rustt", "'rust'"}, std::pair{"hw model --method exac", "'exact'"},
        std::pair{"hw generate -o x --method exct", "'exact'"},
        std::pair{"hw generate -o x --unit exact_9", "'exact_8'"}, std::pair{"help modles", "'models'"}}) {
    const Outcome outcome = burnish(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(first_line(outcome), HasSubstr(fmt::format("; did you mean {}?", meant))) << arguments;
  }
  EXPECT_EQ(burnish("hw error --depth 99").status, 2);
  // Suggestions ignore case, and include topics of help.
  EXPECT_THAT(first_line(burnish("info GGX:alpha_x=0.1")), HasSubstr("; did you mean 'ggx'?"));
  EXPECT_THAT(first_line(burnish("info lambert --illuminant d65")), HasSubstr("; did you mean 'D65'?"));
  EXPECT_THAT(first_line(burnish("formats")), HasSubstr("; did you mean 'help formats'?"));
  const std::string gibberish = first_line(burnish("gibberish"));
  EXPECT_THAT(gibberish, testing::Not(HasSubstr("did you mean")));
  EXPECT_THAT(gibberish, HasSubstr("expected a verb (info, fit, "));
  EXPECT_THAT(gibberish, testing::Not(HasSubstr("describe"))) << "which is not for people";
  const Outcome bare = burnish("");
  EXPECT_EQ(bare.status, 2);
  EXPECT_EQ(first_line(bare), "burnish: expected a verb, found none; there are");
  for (const char* line :
       {"\n  info         Say what", "\n  fit-surface  ", "\n  convert      ", "`burnish VERB --help`"})
    EXPECT_THAT(bare.output, HasSubstr(line));
  EXPECT_THAT(first_line(burnish("hw")),
              HasSubstr("hw: expected a verb (generate, model, error), found none"));
  for (const char* arguments : {"info -o x lambert", "info lambert -ox"})
    EXPECT_EQ(first_line(burnish(arguments)), "burnish: info: expected an option, found '-o'");
  EXPECT_THAT(first_line(burnish("measure lambert --noise -1 -o x")),
              HasSubstr("--noise: expected a number"));
  EXPECT_THAT(first_line(burnish("help fit fit")),
              HasSubstr("help: expected nothing after fit, which has no verbs below it, found 'fit'"));
  EXPECT_THAT(first_line(burnish("help hw fit")),
              HasSubstr("help: expected one of generate, model, error, found 'fit'"));
  // Options of a group are known options.
  EXPECT_THAT(first_line(burnish("describe --bash --zsh")), testing::Not(HasSubstr("expected an option")));
  EXPECT_THAT(first_line(burnish("describe nothing")), testing::Not(HasSubstr("expected a verb")));
  for (const char* model : {"ggxx", "beckman:alpha_x=0.1", "lambertt"}) {
    const Outcome outcome = burnish(fmt::format("info {}", model));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_THAT(outcome.output,
                HasSubstr("expected a file or an analytic model, found neither; did you mean"));
  }
}

TEST(CommandLine, SaysWhatAnOptionTakes) {
  for (const auto& [arguments, said] :
       {std::pair{"measure lambert --noise -1", "--noise: expected a number from 0 to 10, found '-1'"},
        std::pair{"fit lambert --fetches 0", "--fetches: expected a whole number from 1 to 256, found '0'"},
        std::pair{"fit lambert --to openpbr -o x.exr", "--output: expected a name such as paint.json"},
        std::pair{"fit lambert --to openpbr -o x.csv", "--output: expected a name such as paint.json"},
        std::pair{"fit lambert --method svd -o x.gltf", "`burnish export --to gltf` writes a GLB"},
        std::pair{"fit lambert --to gltf -o x.glb", "`burnish export --to gltf` writes a GLB"},
        std::pair{"fit lambert --to gltf -o x.glb", "expected a name such as paint.json or paint.gltf"},
        std::pair{"fit lambert --to openpbr -o x.gltf", "`burnish export --to gltf` writes a GLB"},
        std::pair{"fit lambert --seed a", "--seed: expected a whole number of at least 0, found 'a'"},
        std::pair{"hw error --first 10 --last 5",
                  "--last: expected an exponent of at least --first, 10, found 5"},
        std::pair{"fit lambert --floor 0", "--floor: expected a number above 0 and at most 1, found '0'"}}) {
    const Outcome outcome = burnish(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(first_line(outcome), HasSubstr(said));
  }
}

TEST(CommandLine, RefusesNamesOfAnotherKindBeforeTheWork) {
  for (const auto& [arguments, said] :
       {std::pair{"fit none.csv -o paint.png",
                  "expected a name that ends in .exr or .burnish, found 'paint.png'"},
        std::pair{"fit none.csv -o paint.GLSL", "expected a name that ends in .exr or .burnish"},
        std::pair{"book none -o book.json", "expected a name that ends in .burnish"},
        std::pair{"measure none -o samples.png", "expected a name that ends in .csv or .txt"},
        std::pair{"eval none none -o values.exr", "expected a name that ends in .csv or .txt"},
        std::pair{"convert none -o a.csv --to merl", "expected a name that ends in .binary"},
        std::pair{"export none --to glsl -o paint.glsl", "expected the name of a folder, found 'paint.glsl'"},
        std::pair{"batch none -o library.html", "expected the name of a folder"},
        std::pair{"compare none none -o report.html", "expected the name of a folder"}}) {
    const Outcome outcome = burnish(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(first_line(outcome), HasSubstr(said)) << arguments;
  }
  // Names with other endings are accepted.
  EXPECT_THAT(first_line(burnish("fit none.csv -o paint.v2")), HasSubstr("no such file"));
}

TEST(CommandLine, EvaluatesToTheTerminalAndFromTheStandardInput) {
  const std::string eval = fmt::format("'{}' eval lambert:kd=0.5 ", BURNISH_CLI),
                    f = fmt::format("{}", 0.5 / kPi);
  const std::string row = fmt::format("30,-30,{0},{0},{0}\n", f);
  const Outcome values = run("printf 'theta_i;theta_o\n30;-30\n' | " + eval + "-");
  EXPECT_EQ(values.status, 0);
  EXPECT_EQ(values.output, "theta_i,theta_o,r,g,b\n" + row);

  const TemporaryFolder folder("eval");
  const std::string out = (folder.path / "v.csv").string(), in = (folder.path / "d.csv").string();
  write(in, "\"theta_i\",\"theta_o\"\n30,-30\n");
  EXPECT_EQ(run(eval + in + " -o " + out).output, "");
  EXPECT_EQ(read(out), fmt::format("r,g,b\n{0},{0},{0}\n", f));
  EXPECT_EQ(run(eval + in + " --with-directions -o " + out).output, "");
  EXPECT_EQ(read(out), values.output);
  // Values beside their directions are a table of samples.
  EXPECT_EQ(open_source(out, {}).samples()->size(), 1u);
  const auto json = nlohmann::json::parse(run(eval + in + " --json").output);
  EXPECT_EQ(json["columns"][4], "b");
  EXPECT_EQ(json["rows"][0][1], -30);
  EXPECT_EQ(run(eval + "- < /dev/null").output,
            "burnish: standard input: offset 0: expected data, found nothing\n");
}

TEST(CommandLine, ConvertsWhatWasMeasuredAndSaysWhatAnOptionIsOf) {
  const TemporaryFolder folder("convert_options");
  const std::string out = folder.path.string();
  ASSERT_EQ(burnish(fmt::format("convert lambert '{}/l.mbsdf' --cells 4", out)).status, 0);
  const auto samples = [&](const std::string& options) {
    EXPECT_EQ(burnish(fmt::format("convert '{0}/l.mbsdf' '{0}/l.csv' {1}", out, options)).status, 0);
    return open_source(out + "/l.csv", {}).samples()->size();
  };
  EXPECT_EQ(samples(""), 4u * 4 * 8);
  EXPECT_EQ(samples("--entries"), 4u * 4 * 8);
  EXPECT_EQ(samples("--count 9"), 9u);
  for (const auto& [arguments, said] :
       {std::pair{"l.mbsdf a.bsdf --cells 9", "--cells: expected merl, mbsdf, tensortree, klems or slices"},
        std::pair{"l.mbsdf a.mbsdf --cells 9", "entries that mbsdf keeps as they are"},
        std::pair{"l.mbsdf a.binary --count 9", "--count: expected astm, csv or openmaterial"},
        std::pair{"l.mbsdf a.binary --entries", "--entries: expected"},
        std::pair{"l.mbsdf a.csv --notes", "--notes: expected a .burnish file"},
        std::pair{"l.csv a.csv --count 9", "--count: expected a source to draw from, found 9 samples"}}) {
    const Outcome outcome = run(fmt::format("cd '{}' && '{}' convert {}", out, BURNISH_CLI, arguments));
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_THAT(first_line(outcome), HasSubstr(said)) << arguments;
  }
  const std::string narrow = fmt::format("convert ggx:alpha_x=0.05,alpha_y=0.05 '{}/g.mbsdf' --cells 6", out);
  EXPECT_THAT(burnish(narrow).output, HasSubstr("burnish: g.mbsdf: warning: The values are "));
  EXPECT_EQ(nlohmann::json::parse(burnish(narrow + " --json").output)["warnings"].size(), 1u);
}

TEST(CommandLine, SaysThatAReciprocalFormatDoesNotTellItsOwnError) {
  const TemporaryFolder folder("reciprocal");
  const std::string out = folder.path.string();
  ASSERT_EQ(burnish(fmt::format("convert ggx:alpha_x=0.4,alpha_y=0.4 '{}/g.binary' --cells 8", out)).status,
            0);
  const Outcome compared =
      burnish(fmt::format("compare '{0}/g.binary' lambert -o '{0}/report' --count 500", out));
  EXPECT_EQ(compared.status, 0);
  EXPECT_THAT(compared.output, HasSubstr("the measurement itself           cannot be told from this file\n"));
  EXPECT_THAT(compared.output,
              testing::AllOf(HasSubstr("psnr dB  disc dB    ssim  relative  rms_log  log_cos"),
                             testing::Not(HasSubstr("inf"))));
  EXPECT_THAT(read(folder.path / "report/index.html"), HasSubstr(">cannot be told from this file<"));
}

TEST(CommandLine, PrintsNotesOfAFitAsLines) {
  const TemporaryFolder folder("notes");
  const std::string model = (folder.path / "m.exr").string();
  const Outcome fitted = burnish(
      fmt::format("fit lambert -o '{}' --model pqp --table p=4x4 --table q=4x4 --samples 500", model));
  ASSERT_EQ(fitted.status, 0) << fitted.output;
  EXPECT_THAT(fitted.output, HasSubstr(fmt::format("a file of {} bytes", std::filesystem::file_size(model))));
  EXPECT_THAT(fitted.output, testing::Not(HasSubstr("iteration limit")));
  const std::string said = burnish(fmt::format("info '{}'", model)).output;
  EXPECT_THAT(said, testing::AllOf(HasSubstr("\nfitted to    lambert (analytic)\n"), HasSubstr(", its file "),
                                   testing::Not(HasSubstr("{")), testing::Not(HasSubstr("stop_reason"))));
  const auto json = nlohmann::json::parse(burnish(fmt::format("info '{}' --json", model)).output);
  EXPECT_EQ(json["notes"]["source"], "lambert");
  // An export's targets may stand in a list.
  const std::string out = (folder.path / "out").string();
  ASSERT_EQ(burnish(fmt::format("export '{}' --to glsl,hlsl --to wgsl -o '{}'", model, out)).status, 0);
  for (const char* ending : {"glsl", "hlsl", "wgsl"})
    EXPECT_TRUE(std::filesystem::exists(fmt::format("{}/m.{}", out, ending)));
  EXPECT_EQ(burnish(fmt::format("export '{}' --to glsl,hlls -o '{}'", model, out)).status, 2);
}

TEST(CommandLine, SaysOfOneSampleWhatItKnows) {
  const TemporaryFolder folder("one_sample");
  const std::string file = (folder.path / "one.csv").string();
  write_then_rename(file, "theta_i,phi_i,theta_o,phi_o,value\n30,0,45,180,0.2\n");
  const std::string said = burnish(fmt::format("info '{}'", file)).output;
  EXPECT_THAT(said, HasSubstr("\nnodes        1 measured at 1 incident angle\n"));
  EXPECT_THAT(said, HasSubstr("\nalbedo       unknown at theta_i = 0 degrees\n"));
}

TEST(CommandLine, WritesNoNegativeZeroAndAnAssetOfGltf) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const TemporaryFolder folder("written");
  const std::string patches = (folder.path / "patches.xml").string(),
                    table = (folder.path / "t.csv").string();
  ASSERT_EQ(burnish(fmt::format("convert lambert '{}' --cells 2", patches)).status, 0);
  ASSERT_EQ(burnish(fmt::format("convert '{}' '{}'", patches, table)).status, 0);
  EXPECT_THAT(std::string(read_file(table).text()), testing::Not(testing::ContainsRegex("(^|[,\n])-0[,\n]")));
  const std::string asset = (folder.path / "m.gltf").string();
  ASSERT_EQ(burnish(fmt::format("fit lambert --to gltf --alone -o '{}'", asset)).status, 0);
  EXPECT_TRUE(nlohmann::json::parse(read_file(asset).text()).contains("materials"));
}

TEST(CommandLine, PrintsNotesOfAFitToSamplesAsLines) {
  BURNISH_SKIP_WHERE_SANITIZED();
  const TemporaryFolder folder("notes_of_samples");
  const std::string samples = (folder.path / "s.csv").string(), model = (folder.path / "s.exr").string();
  ASSERT_EQ(burnish(fmt::format("measure ggx:alpha_x=0.4,alpha_y=0.4 -o '{}' --count 60", samples)).status,
            0);
  ASSERT_EQ(burnish(fmt::format("fit '{}' -o '{}' --budget 700", samples, model)).status, 0);
  const std::string said = burnish(fmt::format("info '{}'", model)).output;
  for (const char* line :
       {"\ntarget       60 measured nodes\n", "\nexpected     relative ", " from theta_i = 0 15 ",
        "\n"
        "unseen       each node, predicted by the other nodes: "})
    EXPECT_THAT(said, HasSubstr(line));
  EXPECT_THAT(said, testing::Not(HasSubstr("node_")));
}

TEST(CommandLine, SaysOnATerminalHowFarItIs) {
  BURNISH_SKIP_WHERE_SANITIZED();
  if (!has_tool("script")) GTEST_SKIP() << "no script, which makes a terminal";
  const TemporaryFolder folder("progress");
  const std::string fit = fmt::format("'{}' fit ggx:alpha_x=0.2,alpha_y=0.5 -o '{}/m.exr' --budget 2700",
                                      BURNISH_CLI, folder.path.string());
  const Outcome seen = run(fmt::format("script -qec \"{}\" /dev/null", fit));
  EXPECT_EQ(seen.status, 0);
  EXPECT_THAT(seen.output, testing::AllOf(HasSubstr(" %, "), HasSubstr(" s left"), HasSubstr("\r\033[K")));
  EXPECT_THAT(
      burnish(fmt::format("fit ggx:alpha_x=0.2,alpha_y=0.2 -o '{}/i.exr'", folder.path.string())).output,
      testing::Not(HasSubstr("\r")));
  // A quick verb prints no progress.
  EXPECT_THAT(run(fmt::format("script -qec \"'{}' info lambert --json\" /dev/null", BURNISH_CLI)).output,
              testing::Not(HasSubstr("\033[K")));
}

TEST(CommandLine, RefusesEmptyNames) {
  for (const auto& [arguments, before] :
       {std::pair{"info ''", "info"}, std::pair{"export lambert -o '' --to glsl", "-o"},
        std::pair{"fit lambert -o x.exr --method ''", "--method"}, std::pair{"compare ggx '' -o x", "ggx"},
        std::pair{"export phong --to glsl -o x --name ''", "--name"}}) {
    const Outcome outcome = burnish(arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_EQ(first_line(outcome),
              fmt::format("burnish: expected a name or a value after '{}', found an empty one", before));
  }
}

TEST(CommandLine, TakesSpecsThatAreLongerThanAFilesNameMayBe) {
  std::string spec = "openpbr:";
  for (const char* name : {"base_weight", "base_metalness", "base_diffuse_roughness", "specular_weight",
                           "specular_roughness", "coat_weight", "coat_roughness", "coat_darkening",
                           "fuzz_weight", "fuzz_roughness", "thin_film_weight", "thin_film_thickness"})
    spec += fmt::format("{}=0.123456789,", name);
  spec.pop_back();
  ASSERT_GT(spec.size(), 255u);
  const TemporaryFolder folder("long_spec");
  const std::string out = (folder.path / "out").string();
  for (const std::string& arguments :
       {fmt::format("info {}", spec), fmt::format("export {} --to glsl -o '{}'", spec, out),
        fmt::format("convert {} '{}.csv' --count 5", spec, out),
        fmt::format("render --renderer cpu --material {} --size 8 -o '{}.png'", spec, out)}) {
    const Outcome outcome = burnish(arguments);
    EXPECT_EQ(outcome.status, 0) << arguments << outcome.output;
  }
}

TEST(CommandLine, KeepsErrorsShort) {
  const TemporaryFolder folder("short_errors");
  const std::string digits(9000, '1');
  for (const std::string& text :
       {R"({"kind":"svd","tables":[)" + digits, R"({"kind":")" + digits + R"(","tables":[],"parameters":{}})",
        "{\"lookupTable\":" + digits + "}", "theta_i,phi_i," + digits + "\n", std::string(5000, '{')}) {
    write(folder.path / "damaged", text);
    const Outcome outcome = burnish(fmt::format("info '{}'", (folder.path / "damaged").string()));
    EXPECT_EQ(outcome.status, 1);
    EXPECT_LT(first_line(outcome).size(), 300u) << outcome.output;  // the program's name included
    EXPECT_EQ(std::count(outcome.output.begin(), outcome.output.end(), '\n'), 1);
  }
  EXPECT_LT(first_line(burnish(fmt::format("info {}", digits))).size(), 300u);
  EXPECT_THAT(first_line(burnish("info lambert --illuminant nonsense")),
              HasSubstr("expected E, D50, D65, A or a file"));
  EXPECT_LT(burnish(fmt::format("render lambert --tone {}", digits)).output.size(), 300u);
  EXPECT_LT(burnish(fmt::format("specular code --method {}", digits)).output.size(), 300u);
  EXPECT_THAT(first_line(burnish("help formats extra")),
              HasSubstr("expected nothing after formats, found 'extra'"));
}

TEST(CommandLine, CutsErrorsBetweenCharacters) {
  // The letters have two bytes each, at odd and even places.
  std::string letters;
  for (int i = 0; i < 200; ++i) letters += "\u00e9";
  for (const char* before : {"", "x"}) {
    const std::string line = first_line(burnish(fmt::format("info '{}{}{}'", before, letters, before)));
    EXPECT_THAT(line, HasSubstr(" ... "));
    EXPECT_NO_THROW(nlohmann::json(line).dump()) << line;  // dump() accepts whole characters only
  }
}

TEST(CommandLine, WritesWhereItIsToldTo) {
  const TemporaryFolder folder("output_option");
  const std::string out = folder.path.string();
  for (const std::string& arguments : {fmt::format("convert lambert -o '{}/a.csv' --count 5", out),
                                       fmt::format("convert lambert --output '{}/a.csv' --count 5", out),
                                       fmt::format("convert lambert '{}/a.csv' --count 5", out),
                                       fmt::format("measure lambert -o '{}/a.csv' --count 5", out),
                                       fmt::format("specular table --output '{}/a.csv' --count 5", out),
                                       fmt::format("specular table --out '{}/a.csv' --last 5", out)}) {
    std::filesystem::remove(folder.path / "a.csv");
    EXPECT_EQ(burnish(arguments).status, 0) << arguments;
    EXPECT_TRUE(std::filesystem::exists(folder.path / "a.csv")) << arguments;
  }
  EXPECT_EQ(burnish("convert lambert").status, 2);
  EXPECT_EQ(burnish(fmt::format("convert lambert '{0}/b.csv' -o '{0}/c.csv'", out)).status, 2);
}

TEST(CommandLine, SaysBeforeItsWorkThatItCannotWrite) {
  const TemporaryFolder folder("not_writable");
  const std::string out = folder.path.string();
  write(folder.path / "file", "text");
  // No source exists here, so each message is about the output first.
  for (const auto& [arguments, name] :
       {std::pair{"fit none.exr -o", "x.exr"}, std::pair{"fit none.exr --method svd -o", "x.json"},
        std::pair{"fit none.exr --to gltf -o", "x.json"}, std::pair{"fit-surface none -o", "x.burnish"},
        std::pair{"fit-surface none -o x --picture", "x.png"}, std::pair{"book none -o", "x.burnish"},
        std::pair{"measure none.exr -o", "x.csv"}, std::pair{"convert none.exr -o", "x.csv"},
        std::pair{"eval none.exr none.csv -o", "x.csv"},
        std::pair{"render --renderer cpu --material none.exr -o", "x.png"},
        std::pair{"render --figure1 --truth none.exr -o", "x.png"}})
    for (const char* below : {"none", "file"}) {
      const std::string in = fmt::format("{}/{}", out, below);
      const Outcome outcome = burnish(fmt::format("{} '{}/{}'", arguments, in, name));
      EXPECT_EQ(outcome.status, 1) << arguments;
      EXPECT_EQ(
          outcome.output,
          fmt::format("burnish: {}/{}: expected a path in a folder that is there, found no folder '{}'\n", in,
                      name, in))
          << arguments;
    }
  for (const char* arguments : {"export none.exr --to glsl", "compare none.exr none.exr"})
    for (const char* below : {"file", "file/below"})
      EXPECT_THAT(burnish(fmt::format("{} -o '{}/{}'", arguments, out, below)).output,
                  HasSubstr(fmt::format("{0}/{1}: expected a folder, found '{0}/file'", out, below)))
          << arguments;
  for (const char* arguments : {"specular report", "describe", "hw generate"}) {
    const Outcome outcome = burnish(fmt::format("{} -o '{}/file'", arguments, out));
    EXPECT_EQ(outcome.status, 1) << arguments;
    EXPECT_EQ(
        outcome.output,
        fmt::format("burnish: {}/file: expected a folder that can be made, found Not a directory\n", out))
        << arguments;
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path), {}), 1);
}

TEST(CommandLine, MakesNoFolderForWhatItRefuses) {
  const TemporaryFolder folder("refused");
  for (const char* arguments :
       {"hw generate --name 1a", "hw generate --blinn", "hw generate --method exct"}) {
    const Outcome outcome = burnish(fmt::format("{} -o '{}/out'", arguments, folder.path.string()));
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_FALSE(std::filesystem::exists(folder.path / "out")) << arguments;
  }
}

TEST(CommandLine, PrintsJsonForPrograms) {
  const TemporaryFolder folder("json");
  const std::string out = folder.path.string();
  write(folder.path / "d.csv", seeds::kDirections);
  const auto json = [&](const std::string& arguments) {
    const Outcome outcome = run(fmt::format("'{}' {} --json 2>/dev/null", BURNISH_CLI, arguments));
    EXPECT_EQ(outcome.status, 0) << arguments;
    return nlohmann::json::parse(outcome.output);
  };
  EXPECT_EQ(json(fmt::format("convert ggx '{}/g.csv' --count 7", out))["format"], "csv");
  EXPECT_EQ(json(fmt::format("measure ggx -o '{}/m.csv' --count 7", out))["samples"], 7);
  EXPECT_EQ(json(fmt::format("eval ggx '{0}/d.csv' -o '{0}/v.csv'", out))["pairs"], 2);
  EXPECT_EQ(json("info lambert")["format"], "analytic");
  const auto made = json(fmt::format("fit ggx -o '{}/f.exr' --budget 300 --samples 2000", out))["shader"];
  EXPECT_GT(made["operations"], 10);
  EXPECT_EQ(made, json(fmt::format("info '{}/f.exr'", out))["shader"]);
  EXPECT_EQ(json(fmt::format("export phong:exponent=9 --to glsl -o '{}/e'", out))["output"], out + "/e");
  EXPECT_GT(json("help formats").size(), 15u);
  EXPECT_GT(json("help models").size(), 10u);
  EXPECT_EQ(json("help specular code")["name"], "specular code");
  const std::string ball = "render --renderer cpu --material lambert --size 8x6 --vertices 64 --samples 1";
  EXPECT_EQ(json(fmt::format("{} -o '{}/ball.png'", ball, out))["height"], 6);
  EXPECT_EQ(json("specular code --method cubic2 --lang glsl")["language"], "glsl");
  EXPECT_EQ(json(fmt::format("specular table --count 3 -o '{}/t.csv'", out))["output"], out + "/t.csv");
  EXPECT_EQ(json(fmt::format("specular plot -o '{}/p.svg'", out))["figure"], "2a");
  EXPECT_FALSE(json(fmt::format("hw generate --vectors 2 -o '{}/unit'", out))["files"].empty());
  const auto piped = [&](const char* lines, const char* arguments) {
    return nlohmann::json::parse(
        run(fmt::format("printf '{}' | '{}' {} --json", lines, BURNISH_CLI, arguments)).output);
  };
  EXPECT_EQ(piped("1\\n0.5\\n", "specular eval --method exact --exponent 2")[1]["value"], 0.25);
  EXPECT_EQ(piped("50 32768\\n", "hw model --method exact")[0]["input"], 32768);
}

/// Appends every verb that has no verbs below it, with its entry of `describe --json`.
void append_leaves(const nlohmann::json& verb, std::vector<nlohmann::json>& leaves) {
  if (verb["verbs"].empty()) leaves.push_back(verb);
  for (const nlohmann::json& below : verb["verbs"]) append_leaves(below, leaves);
}

std::vector<std::string> names_of(const nlohmann::json& verb) {
  std::vector<std::string> names;
  for (const nlohmann::json& argument : verb["arguments"])
    for (const nlohmann::json& name : argument["names"]) names.push_back(name.get<std::string>());
  return names;
}

TEST(CommandLine, HasJsonHelpAndExamplesInEveryVerb) {
  std::vector<nlohmann::json> verbs;
  append_leaves(nlohmann::json::parse(burnish("describe --json").output), verbs);
  verbs.push_back(nlohmann::json::parse(burnish("help describe --json").output));
  EXPECT_GT(verbs.size(), 20u);
  for (const nlohmann::json& verb : verbs) {
    const std::string name = verb["name"], examples = verb["examples"];
    const std::vector<std::string> names = names_of(verb);
    EXPECT_THAT(names, testing::IsSupersetOf({"--help", "--json"})) << name;
    // Options for the output have the same name everywhere, and so do options for its format.
    for (const char* output : {"-o", "--output", "--out"})
      EXPECT_EQ(std::ranges::count(names, output), std::ranges::count(names, "-o")) << name;
    for (const auto& [other, common] : {std::pair{"--folder", "-o"}, {"--file", "-o"}, {"--lang", "--to"}})
      if (std::ranges::find(names, other) != names.end()) {
        EXPECT_THAT(names, testing::Contains(common)) << name;
      }
    EXPECT_THAT(examples, HasSubstr("burnish " + name)) << name;
    EXPECT_THAT(burnish(name + " --help").output, HasSubstr(examples.substr(0, examples.find('\n')))) << name;
    for (const nlohmann::json& argument : verb["arguments"]) {
      // The description is one plain sentence.
      const std::string said = argument["description"];
      SCOPED_TRACE(fmt::format("{} {}: {}", name, argument["names"].dump(), said));
      ASSERT_FALSE(said.empty());
      EXPECT_TRUE(said.front() >= 'A' && said.front() <= 'Z' && said.back() == '.');
      EXPECT_THAT(said, testing::Not(HasSubstr(". ")));
      EXPECT_LE(std::ranges::count(said, ' '), 24);
    }
    EXPECT_LE(std::ranges::count(verb["description"].get<std::string>(), ' '), 24) << name;
  }
}

TEST(CommandLine, ShowsExamplesOfOptionsThatThereAre) {
  std::vector<nlohmann::json> verbs;
  append_leaves(nlohmann::json::parse(burnish("describe --json").output), verbs);
  for (const nlohmann::json& verb : verbs) {
    const std::vector<std::string> names = names_of(verb);
    std::istringstream lines(verb["examples"].get<std::string>());
    for (std::string line; std::getline(lines, line);) {
      const std::size_t call = line.find(fmt::format("burnish {} ", verb["name"].get<std::string>()));
      if (call == std::string::npos) continue;
      std::istringstream words(line.substr(call, line.find(" | ", call) - call));
      for (std::string word; words >> word;)
        if (word.starts_with("--")) {
          EXPECT_THAT(names, testing::Contains(word.substr(0, word.find('=')))) << line;
        }
    }
  }
}

TEST(CommandLine, TellsWhatItCanOfSamplesNearGrazing) {
  const TemporaryFolder folder("grazing");
  write(folder.path / "g.csv",
        "theta_i,phi_i,theta_o,phi_o,value\n85,0,85,180,1\n86,0,84,180,2\n84,0,86,170,1\n");
  const Outcome outcome = burnish(fmt::format("info '{}/g.csv'", folder.path.string()));
  EXPECT_EQ(outcome.status, 0) << outcome.output;
  EXPECT_THAT(outcome.output, HasSubstr("3 measured"));
}

TEST(CommandLine, DescribesWhatWasMeasuredAlone) {
  EXPECT_THAT(first_line(burnish("info lambert --target nodes")), HasSubstr("lambert"));
  EXPECT_EQ(burnish("info lambert --target nodes").status, 1);
  EXPECT_EQ(burnish("info lambert --target edges").status, 2);

  BURNISH_SKIP_WHERE_SANITIZED();
  const TemporaryFolder folder("nodes");
  const std::string file = (folder.path / "m.csv").string();
  ASSERT_EQ(burnish(fmt::format("measure ggx:alpha_x=0.4,alpha_y=0.4 -o '{}' --count 600 --noise 0.1", file))
                .status,
            0);
  const auto json =
      nlohmann::json::parse(burnish(fmt::format("info '{}' --target nodes --json", file)).output);
  EXPECT_EQ(json["count"], 600);
  EXPECT_EQ(json["negative_share"], 0);
  // The error comes from noise of a tenth, and from interpolation between few samples.
  EXPECT_GT(json["held_out"]["relative"], 0.03);
  EXPECT_LT(json["held_out"]["relative"], 0.3);
  EXPECT_THAT(burnish(fmt::format("info '{}' --target nodes", file)).output,
              testing::AllOf(HasSubstr("600, "), HasSubstr("unseen")));
}

TEST(CommandLine, SaysHowFarOffMeasurementsAreAndWhereToMeasureNext) {
  EXPECT_THAT(first_line(burnish("measure lambert --next 2")), HasSubstr("lambert: expected a measurement"));
  EXPECT_EQ(burnish("measure lambert --next 2 --count 5").status, 2);
  EXPECT_EQ(burnish("measure lambert --next 0").status, 2);

  BURNISH_SKIP_WHERE_SANITIZED();
  const TemporaryFolder folder("next");
  const std::string file = (folder.path / "m.csv").string(), values = (folder.path / "v.csv").string(),
                    directions = (folder.path / "d.csv").string();
  ASSERT_EQ(burnish(fmt::format("measure ggx:alpha_x=0.4,alpha_y=0.4 -o '{}' --count 100 --noise 0.05", file))
                .status,
            0);
  const auto json = nlohmann::json::parse(burnish(fmt::format("measure '{}' --next 3 --json", file)).output);
  ASSERT_EQ(json["next"].size(), 3u);
  for (const auto& next : json["next"]) {
    EXPECT_EQ(next["phi_i_deg"], 0);
    EXPECT_GT(next["error"], 0);
  }
  write_then_rename(directions, "wi_x,wi_y,wi_z,wo_x,wo_y,wo_z\n0,0,1,0,0,1\n");
  ASSERT_EQ(burnish(fmt::format("eval '{}' '{}' -o '{}' --error", file, directions, values)).status, 0);
  EXPECT_THAT(std::string(read_file(values).text()), testing::StartsWith("r,g,b,error\n"));
}

TEST(CommandLine, ExplainsItsFormatsAndItself) {
  const Outcome formats = burnish("help formats");
  EXPECT_EQ(formats.status, 0);
  for (const char* name : {"UTIA", "OpenMATERIAL", "tensor tree", "ALTA", "Speos"})
    EXPECT_THAT(formats.output, HasSubstr(name));
  EXPECT_THAT(burnish("help fit").output, HasSubstr("--budget"));
  EXPECT_THAT(burnish("help specular code").output, HasSubstr("Usage: burnish specular code [OPTIONS]"));
  const std::string verbs = burnish("help").output, models = burnish("help models").output;
  for (const char* verb : {"convert", "fit-surface", "specular"}) EXPECT_THAT(verbs, HasSubstr(verb));
  for (const char* said : {"lambert", "ggx", "alpha_x", "openpbr", "thin_film_thickness"})
    EXPECT_THAT(models, HasSubstr(said));
  EXPECT_EQ(burnish("help nonsense").status, 2);
  const Outcome version = burnish("--version");
  EXPECT_EQ(version.status, 0);
  for (const char* said :
       {"burnish ", "instruction sets", "threads", "CLI11 2", "OpenEXR 3", "zstd 1", "libepoxy 1", "LAPACK"})
    EXPECT_THAT(version.output, HasSubstr(said));
  const auto json = nlohmann::json::parse(burnish("--json --version").output);
  EXPECT_THAT(version.output, HasSubstr("burnish " + json["burnish"].get<std::string>()));
  EXPECT_EQ(json["compiled_with"].size(), 1 + build_info().libraries.size());
  EXPECT_EQ(burnish("--json help formats").status, 2);  // a verb's --json follows the verb
}

// Returns a window's sheet: values of its reflection, and another value of its transmission.
std::string sheet_xml() {
  const auto block = [](std::string_view direction, std::string_view band, double value) {
    return fmt::format(
        "<WavelengthData><Wavelength>{}</Wavelength><WavelengthDataBlock><WavelengthDataDirection>{}"
        "</WavelengthDataDirection><ColumnAngleBasis>One</ColumnAngleBasis><RowAngleBasis>One</RowAngleBasis>"
        "<ScatteringData>{}</ScatteringData></WavelengthDataBlock></WavelengthData>",
        band, direction, value);
  };
  return "<WindowElement><Optical><Layer><DataDefinition><IncidentDataStructure>Columns</"
         "IncidentDataStructure>"
         "<AngleBasis><AngleBasisName>One</AngleBasisName><AngleBasisBlock><nPhis>1</nPhis><ThetaBounds>"
         "<LowerTheta>0</LowerTheta><UpperTheta>90</UpperTheta></ThetaBounds></AngleBasisBlock></AngleBasis>"
         "</DataDefinition>" +
         block("Reflection Front", "Visible", 0.1) + block("Transmission Front", "Visible", 0.2) +
         block("Transmission Front", "NIR", 0.3) + "</Layer></Optical></WindowElement>";
}

TEST(CommandLine, ReadsEachPartAndBandOfASurface) {
  const TemporaryFolder folder("parts");
  const std::string file = (folder.path / "sheet.xml").string(),
                    model = (folder.path / "sheet.burnish").string();
  write_then_rename(file, sheet_xml());
  const std::string info = burnish("info " + file).output;
  EXPECT_THAT(info, HasSubstr("part         reflection-front (Visible): read\n"));
  EXPECT_THAT(info, HasSubstr("part         transmission-front (NIR): left out\n"));
  const auto json = nlohmann::json::parse(burnish("info --json --band nir " + file).output);
  EXPECT_EQ(json.at("part"), "transmission-front");
  EXPECT_EQ(json.at("band"), "NIR");
  EXPECT_EQ(json.at("parts").size(), 3u);
  EXPECT_EQ(json.at("parts").at(2).at("read"), true);

  // A part that the file lacks is an error of one line. A word that names no part is a misuse.
  const Outcome missing = burnish("info --part transmission-back " + file);
  EXPECT_EQ(missing.status, 1);
  EXPECT_THAT(missing.output, HasSubstr("expected part transmission-back, found reflection-front (Visible), "
                                        "transmission-front (Visible), transmission-front (NIR)\n"));
  EXPECT_EQ(burnish("info --part transmission " + file).status, 2);

  // In files and in models fitted to them, wo lies below the surface.
  const auto values = [&](const std::string& brdf) {
    return run(fmt::format(
                   "printf 'theta_i,phi_i,theta_o,phi_o\\n30,0,140,20\\n30,0,40,20\\n' | '{}' eval {} -",
                   BURNISH_CLI, brdf))
        .output;
  };
  EXPECT_THAT(values(file + " --part transmission-front"), HasSubstr("30,0,140,20,0.2"));
  EXPECT_THAT(values(file + " --part transmission-front"), HasSubstr("30,0,40,20,0\n"));
  EXPECT_THAT(values(file), HasSubstr("30,0,40,20,0.1"));
  const Outcome fitted = burnish(fmt::format(
      "fit {} --part transmission-front --model 'q(h)' --table q=8 --samples 2000 -o {}", file, model));
  EXPECT_EQ(fitted.status, 0) << fitted.output;
  EXPECT_THAT(values(model), HasSubstr("30,0,140,20,0.200"));
  EXPECT_THAT(values(model), HasSubstr("30,0,40,20,0\n"));
  EXPECT_THAT(burnish("info " + model).output, HasSubstr("part         transmission-front (Visible)\n"));
  EXPECT_THAT(burnish("compare " + file + " " + model).output, HasSubstr("expected reflection as in"));
  EXPECT_EQ(burnish("compare " + file + " " + model + " --part transmission-front").status, 0);
}

TEST(CommandLine, TakesTheLightOfSpectraFromAName) {
  const TemporaryFolder folder("illuminants");
  const std::string out = folder.path.string();
  write(folder.path / "c.brdf", seeds::kCornell);
  write(folder.path / "light.txt", "# nm power\n380 1\n780 1\n");
  const auto converted = [&](const std::string& light) {
    EXPECT_EQ(burnish(fmt::format("convert '{0}/c.brdf' '{0}/c.csv' --illuminant {1}", out, light)).status,
              0);
    return read(folder.path / "c.csv");
  };
  const auto drawn = [&](const std::string& light) {
    const std::string material =
        fmt::format("--mesh sphere --material '{}/c.brdf' --illuminant {}", out, light);
    EXPECT_EQ(burnish(fmt::format("render --renderer cpu --size 8 {} -o '{}/c.exr'", material, out)).status,
              0);
    return read(folder.path / "c.exr");
  };
  EXPECT_NE(drawn("A"), drawn("D65"));
  EXPECT_NE(converted("D50"), converted("D65"));
  EXPECT_NE(converted("A"), converted("E"));
  // Equal energy may come from a file. The file's rows split the same sum at other places.
  const Source named = parse_source(memory_file(converted("E")), {});
  const Source given = parse_source(memory_file(converted(out + "/light.txt")), {});
  for (std::size_t i = 0; i < named.samples()->values.size(); ++i)
    EXPECT_NEAR(named.samples()->values[i], given.samples()->values[i], 1e-6);
  EXPECT_EQ(burnish(fmt::format("info '{0}/c.brdf' --illuminant none", out)).status, 1);
}

}  // namespace
}  // namespace burnish
