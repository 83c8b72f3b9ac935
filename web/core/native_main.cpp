// The page's core as a native program, for the tests: what it says is what the page has to say.
//   plumb_web_native study|begin < JSON      the answer; of a scene also what was decided and all that was said as two
//   digests
//   plumb_web_native files < JSON            the files of that scene
#include <cinttypes>
#include <cstdio>
#include <cstring>
#include <iostream>
#include <iterator>
#include <string>

#include "explorer.hpp"

namespace {

/// A scene's records, one a line: every number as 16 hexadecimal digits.
void print_records(const plumb_web::Play& play) {
  const std::size_t width = plumb_web::record_names().size();
  for (std::size_t k = 0; k < play.records().size(); ++k) {
    std::uint64_t bits = 0;
    std::memcpy(&bits, &play.records()[k], sizeof bits);
    std::printf("%016" PRIx64 "%c", bits, (k + 1) % width == 0 ? '\n' : ' ');
  }
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  const bool records = argc > 2 && std::string(argv[2]) == "--records";
  if (what == "vocabulary") return std::printf("%s\n", plumb_web::vocabulary().c_str()) < 0;
  const std::string text((std::istreambuf_iterator<char>(std::cin)), std::istreambuf_iterator<char>());
  if (what == "builtin") return std::printf("%s\n", plumb_web::builtin_axes(text).c_str()) < 0;
  if (what == "study") return std::printf("%s\n", plumb_web::study(text).c_str()) < 0;
  if (what != "begin" && what != "files") {
    std::fprintf(stderr, "usage: plumb_web_native vocabulary | builtin | study | files | begin [--records]  < TEXT\n");
    return 2;
  }
  plumb_web::Play play;
  const std::string begun = play.begin(text);
  std::printf("%s\n", what == "files" ? play.files().c_str() : begun.c_str());
  if (what == "files") return 0;
  while (play.run(1000) > 0) continue;
  std::printf("decisions %016" PRIx64 "\n", play.decisions());
  std::printf("digest %016" PRIx64 "\n", play.digest());
  if (records) print_records(play);
  return 0;
}
