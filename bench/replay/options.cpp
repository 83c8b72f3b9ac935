#include "options.hpp"

#include <charconv>
#include <cstdio>
#include <cstring>

namespace plumb_replay {
namespace {

template <class T>
bool number(const char* text, T& out) {
  const char* end = text + std::strlen(text);
  const auto read = std::from_chars(text, end, out);
  return read.ec == std::errc() && read.ptr == end;
}

/// Where the value of an option goes; null where there is no such option.
std::string* text_of(const std::string& option, Options& out) {
  if (option == "--data") return &out.data;
  if (option == "--examples") return &out.examples;
  if (option == "--words") return &out.words;
  if (option == "--trace") return &out.trace;
  if (option == "--only") return &out.only;
  if (option == "--perturb") return &out.perturb;
  return nullptr;
}

bool take(const std::string& option, const char* value, Options& out) {
  if (option == "--seed") return number(value, out.seed);
  if (option == "--scenarios") return number(value, out.scenarios) && out.scenarios >= 0 && out.scenarios <= 10000000;
  std::string* text = text_of(option, out);
  if (text != nullptr) *text = value;
  return text != nullptr;
}

}  // namespace

const char* usage() {
  return "usage: plumb_replay [options]\n"
         "Plays a corpus of cases into the monitor and prints a line for each: name, samples, and the digests of what "
         "it was\n"
         "given, its answers, verdicts, events and snapshots. scripts/replay compares two commits by it.\n"
         "  --seed S         of the generated cases (1)\n"
         "  --scenarios N    how many of them (2000)\n"
         "  --data DIR       recordings (default: none), read by the array files in --examples DIR\n"
         "  --only PREFIX    cases whose names begin so\n"
         "  --trace CASE     one case as text: every figure at the sample at which it changes; not a corpus\n"
         "  --words FILE     lines \"old new\": words that are called otherwise now, digested by their new name\n"
         "  --perturb CASE   the monitor gets one sample of that case one unit in the last place more\n"
         "  --quick          a few seconds: 60 generated cases, one of each drill\n";
}

bool parse(int argc, char** argv, Options& out) {
  for (int k = 1; k < argc; ++k) {
    const std::string option = argv[k];
    if (option == "--help" || option == "-h") {
      out.help = true;
    } else if (option == "--quick") {
      out.quick = true;
      out.scenarios = 60;
    } else if (k + 1 >= argc || !take(option, argv[k + 1], out)) {
      std::fprintf(stderr, "plumb_replay: %s: no such option, or not with that value\n%s", option.c_str(), usage());
      return false;
    } else {
      ++k;
    }
  }
  return true;
}

}  // namespace plumb_replay
