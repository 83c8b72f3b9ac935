#include "plumb/geomagnetic/coefficient_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <utility>
#include <vector>

#include "plumb/io/printable.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace geomagnetic {
namespace {

constexpr std::size_t kMostBytes = 1'000'000;
constexpr double kMostCoefficient_nt = 100e3;
constexpr double kYearsValid = 5.0;

std::vector<std::string_view> words_of(std::string_view line) {
  std::vector<std::string_view> out;
  std::size_t at = 0;
  while ((at = line.find_first_not_of(" \t\r", at)) != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(" \t\r", at), line.size());
    out.push_back(line.substr(at, end - at));
    at = end;
  }
  return out;
}

template <class T>
bool read_number(std::string_view word, T& out) {
  const char* const end = word.data() + word.size();
  const auto result = std::from_chars(word.data(), end, out);
  return result.ec == std::errc() && result.ptr == end;
}

class Reader {
 public:
  explicit Reader(const std::string& name) : name_(name) { model_.g_nt.fill(std::numeric_limits<double>::quiet_NaN()); }

  io::FileExpected<void> take_line(std::string_view line) {
    ++line_;
    const std::vector<std::string_view> words = words_of(line);
    if (words.empty() || ended_) return {};
    if (words[0].find_first_not_of('9') == std::string_view::npos && words[0].size() > 6) {
      ended_ = true;
      return {};
    }
    return model_.name.empty() ? take_head(words) : take_row(words);
  }

  io::FileExpected<FieldModel> finish() {
    if (model_.name.empty()) return refuse("is empty", "give a file in the form of WMM.COF");
    for (int n = 1; n <= kMaxDegree; ++n) {
      for (int m = 0; m <= n; ++m) {
        if (std::isnan(model_.g_nt[coefficient_index(n, m)]))
          return refuse(fmt::format("has no coefficient of degree {} and order {}", n, m),
                        "give all 90 of degree 1 to 12");
      }
    }
    return std::move(model_);
  }

 private:
  tl::unexpected<io::FileError> refuse(std::string what, std::string remedy) const {
    return tl::unexpected<io::FileError>(
        io::FileError{name_, line_, "", std::move(what), std::move(remedy), io::ExitCode::invalid_input});
  }

  io::FileExpected<void> take_head(const std::vector<std::string_view>& words) {
    if (words.size() < 2 || words.size() > 4 || !read_number(words[0], model_.epoch_year) ||
        !(model_.epoch_year >= 1900.0 && model_.epoch_year <= 2200.0))
      return refuse("does not begin with epoch, name and date of release",
                    "give a file in the form of WMM.COF: \"2025.0 WMM-2025 11/13/2024\"");
    model_.name = io::printable_line(words[1]);
    model_.first_year = model_.epoch_year;
    model_.last_year = model_.epoch_year + kYearsValid;
    return {};
  }

  io::FileExpected<void> take_row(const std::vector<std::string_view>& words) {
    int n = 0, m = 0;
    std::array<double, 4> value{};
    bool numbers = words.size() == 6 && read_number(words[0], n) && read_number(words[1], m);
    for (std::size_t k = 0; numbers && k < value.size(); ++k)
      numbers = read_number(words[2 + k], value[k]) && std::fabs(value[k]) <= kMostCoefficient_nt;
    if (!numbers)
      return refuse("is no row of degree, order, g, h and their change a year",
                    "give six numbers, the last four in nT and below 100000");
    if (n < 1 || n > kMaxDegree || m < 0 || m > n)
      return refuse(fmt::format("has degree {} and order {}", n, m),
                    "cut the file at degree 12; orders are 0 to degree");
    const std::size_t at = coefficient_index(n, m);
    if (!std::isnan(model_.g_nt[at]))
      return refuse(fmt::format("has degree {} and order {} a second time", n, m), "remove one of them");
    if (m == 0 && (value[1] != 0.0 || value[3] != 0.0))
      return refuse(fmt::format("has an h of order 0 at degree {}", n),
                    "it must be 0: the sine of 0 has no coefficient");
    model_.g_nt[at] = value[0];
    model_.h_nt[at] = value[1];
    model_.g_nt_per_year[at] = value[2];
    model_.h_nt_per_year[at] = value[3];
    return {};
  }

  std::string name_;
  int line_ = 0;
  bool ended_ = false;
  FieldModel model_;
};

}  // namespace

io::FileExpected<FieldModel> parse_coefficients(std::string_view text, const std::string& name) {
  Reader reader(name);
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    if (const io::FileExpected<void> taken = reader.take_line(text.substr(0, end)); !taken)
      return tl::unexpected<io::FileError>(taken.error());
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  return reader.finish();
}

io::FileExpected<FieldModel> read_coefficients(const std::string& path) {
  const auto refuse = [&path](const char* what, const char* remedy) {
    return tl::unexpected<io::FileError>(io::FileError{path, 0, "", what, remedy, io::ExitCode::invalid_input});
  };
  std::ifstream in(path, std::ios::binary);
  if (!in) return refuse("cannot be opened", "check the path and the permissions");
  std::string text(kMostBytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad() || (in.fail() && !in.eof())) return refuse("cannot be read", "check that it is a file");
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kMostBytes) return refuse("is larger than 1 MB", "give a file in the form of WMM.COF: it has 5 kB");
  return parse_coefficients(text, path);
}

}  // namespace geomagnetic
}  // namespace PLUMB_ABI
}  // namespace plumb
