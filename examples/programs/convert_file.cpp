// SPDX-License-Identifier: Apache-2.0
// Converts a measurement to another format with burnish::io: convert_file FILE FORMAT RESULT. The format is one of
// kConvertFormats. Prints what the result loses.
#include <cstdio>
#include <exception>

#include <burnish/file.h>
#include <burnish/io/convert.h>
#include <burnish/io/open_source.h>

int main(int count, char** arguments) {
  if (count != 4) {
    std::fprintf(stderr, "usage: convert_file FILE FORMAT RESULT\n");
    return 2;
  }
  try {
    const burnish::Source source = burnish::open_source(arguments[1], {});
    const burnish::Converted converted = burnish::convert(source, arguments[2]);
    burnish::write_then_rename(arguments[3], converted.bytes);
    for (const auto& loss : converted.losses) std::printf("lost: %s\n", loss.c_str());
    std::printf("%s is written: %zu bytes\n", arguments[3], converted.bytes.size());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
