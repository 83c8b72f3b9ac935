#include "plumb/noise/still_log.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "plumb/noise/fit.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace noise {
namespace {

/// Rows that may be missing in a row and are filled; more are a gap.
constexpr std::size_t kMostFilled = 5;
/// A step of time up to this times the usual one is one step.
constexpr double kOneStep = 1.5;
/// Scatter within a block, and step from a block to the next, in units of the usual ones: beyond these the log moves.
/// Those of noise stay far below, slow terms among it.
constexpr double kScatter = 5.0, kStep = 10.0;
/// A block of rest is a second, within these numbers of readings; fewer blocks than this judge nothing.
constexpr double kBlock_s = 1.0;
constexpr std::size_t kShortestBlock = 16, kLongestRestBlock = 1000, kFewestBlocks = 8;
/// Median of |x| of a normal law over its sigma.
constexpr double kMedianOfNormal = 0.6744897501960817;
constexpr std::size_t kReadingsForResolution = 100000;
/// Beyond these no sampling of an accelerometer is; the fourth powers of readings within kLargest, and of steps
/// above its inverse, stay numbers.
constexpr double kShortestPeriod_s = 1e-9, kLongestPeriod_s = 1e9, kLargest = 1e50;

/// Readings in a row, evenly spaced.
struct Piece {
  double begin_s = 0.0;
  std::vector<double> readings;
  std::size_t filled = 0;
};

double median_of(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void note(Stretch& out, BreakCode code, double time_s, double value) {
  Breaks& kind = out.breaks[static_cast<std::size_t>(code)];
  const Break one{code, time_s, value};
  if (kind.count++ == 0 || one.time_s < kind.first.time_s) kind.first = one;
  if (kind.count == 1 || one.value > kind.worst.value) kind.worst = one;
}

/// Sets the period and how even the steps of time are.
void find_period(const StillLog& log, Stretch& out) {
  if (log.time_s.empty()) {
    out.period_s = log.rate_hz > 0.0 ? 1.0 / log.rate_hz : 0.0;
    return;
  }
  std::vector<double> steps;
  for (std::size_t k = 1; k < log.time_s.size(); ++k) steps.push_back(log.time_s[k] - log.time_s[k - 1]);
  const double usual = median_of(steps);
  double sum = 0.0, count = 0.0, odd = 0.0;
  // A clock of whole milliseconds steps by 2 and 3: their mean counts, not their median.
  for (const double step : steps) {
    if (!(step <= 1.6 * usual)) continue;
    sum += step;
    count += 1.0;
  }
  if (!(sum > 0.0)) return;
  out.period_s = sum / count;
  for (const double step : steps) odd += std::fabs(step / out.period_s - 1.0) > 0.5 ? 1.0 : 0.0;
  out.irregular = odd / static_cast<double>(steps.size());
  if (out.irregular <= kIrregular) return;
  // Rows come in bursts: only the whole tells the rate.
  out.period_s = (log.time_s.back() - log.time_s.front()) / static_cast<double>(steps.size());
}

/// Readings that are missing between two that are there, on the line between them.
void fill(Piece& piece, std::size_t count, double next) {
  const double last = piece.readings.back();
  for (std::size_t i = 1; i <= count; ++i)
    piece.readings.push_back(last + (next - last) * static_cast<double>(i) / static_cast<double>(count + 1));
  piece.filled += count;
}

double time_of(const StillLog& log, const Stretch& out, std::size_t row) {
  return log.time_s.empty() ? static_cast<double>(row) * out.period_s : log.time_s[row];
}

/// Rows missing between one row and the next.
std::size_t missing_before(const StillLog& log, const Stretch& out, std::size_t row) {
  if (log.time_s.empty() || row == 0) return 0;
  const double steps = (log.time_s[row] - log.time_s[row - 1]) / out.period_s;
  if (out.irregular > kIrregular && steps <= static_cast<double>(kMostFilled) + kOneStep) return 0;
  if (steps <= kOneStep) return 0;
  return static_cast<std::size_t>(std::min(std::round(steps) - 1.0, 1e15));
}

std::vector<Piece> even_pieces(const StillLog& log, const std::vector<double>& readings, Stretch& out) {
  std::vector<Piece> pieces(1);
  std::size_t missing = 0;      // since the last reading
  std::size_t silent_rows = 0;  // of these, rows that are there without a reading
  for (std::size_t row = 0; row < readings.size(); ++row) {
    missing += missing_before(log, out, row);
    if (!(std::fabs(readings[row]) < kLargest)) {
      ++missing;
      ++silent_rows;
      continue;
    }
    Piece& piece = pieces.back();
    if (piece.readings.empty()) {
      piece.begin_s = time_of(log, out, row);
    } else if (missing <= kMostFilled) {
      fill(piece, missing, readings[row]);
    } else {
      const double silence_s = static_cast<double>(missing) * out.period_s;
      note(out, 2 * silent_rows >= missing ? BreakCode::silent : BreakCode::gap, time_of(log, out, row) - silence_s,
           silence_s);
      pieces.push_back({time_of(log, out, row), {}, 0});
    }
    pieces.back().readings.push_back(readings[row]);
    missing = silent_rows = 0;
  }
  return pieces;
}

struct RestBlock {
  double mean = 0.0;
  double sigma = 0.0;
};

std::vector<RestBlock> blocks_of(const Piece& piece, std::size_t length) {
  std::vector<RestBlock> out;
  for (std::size_t at = 0; at + length <= piece.readings.size(); at += length) {
    const double first = piece.readings[at], n = static_cast<double>(length);
    double sum = 0.0, square = 0.0;
    for (std::size_t i = at; i < at + length; ++i) {
      const double off = piece.readings[i] - first;
      sum += off;
      square += off * off;
    }
    out.push_back({first + sum / n, std::sqrt(std::max(0.0, square - sum * sum / n) / (n - 1.0))});
  }
  return out;
}

/// What is usual in this log.
struct Usual {
  double sigma = 0.0;
  double step = 0.0;  ///< of block means, 1 sigma
};

Usual usual_of(const std::vector<std::vector<RestBlock>>& pieces, std::size_t length) {
  std::vector<double> sigmas, steps;
  for (const std::vector<RestBlock>& blocks : pieces) {
    for (std::size_t b = 0; b < blocks.size(); ++b) {
      sigmas.push_back(blocks[b].sigma);
      if (b > 0) steps.push_back(std::fabs(blocks[b].mean - blocks[b - 1].mean));
    }
  }
  Usual out;
  if (sigmas.size() < kFewestBlocks) return out;
  out.sigma = median_of(std::move(sigmas));
  out.step =
      std::max(median_of(std::move(steps)) / kMedianOfNormal, out.sigma * std::sqrt(2.0 / static_cast<double>(length)));
  return out;
}

/// The parts of a piece between blocks that move, which go with their neighbours.
void cut_at_motion(Piece&& piece, const std::vector<RestBlock>& blocks, std::size_t length, const Usual& usual,
                   Stretch& out, std::vector<Piece>& at_rest) {
  std::vector<bool> moves(blocks.size(), false);
  for (std::size_t b = 0; b < blocks.size() && usual.sigma > 0.0; ++b) {
    const double scatter = blocks[b].sigma / usual.sigma;
    const double step = b > 0 ? std::fabs(blocks[b].mean - blocks[b - 1].mean) / usual.step : 0.0;
    if (scatter <= kScatter && step <= kStep) continue;
    if (b == 0 || !moves[b - 1])  // where one motion lasts, it is told once
      note(out, BreakCode::motion, piece.begin_s + static_cast<double>(b * length) * out.period_s,
           std::max(scatter / kScatter * kStep, step));
    moves[b] = true;
  }
  std::size_t from = 0;
  const auto end_rest = [&](std::size_t to) {
    if (to <= from) return;
    Piece part;
    part.begin_s = piece.begin_s + static_cast<double>(from) * out.period_s;
    part.readings.assign(piece.readings.begin() + static_cast<std::ptrdiff_t>(from),
                         piece.readings.begin() + static_cast<std::ptrdiff_t>(to));
    part.filled = piece.filled;
    at_rest.push_back(std::move(part));
  };
  if (std::none_of(moves.begin(), moves.end(), [](bool m) { return m; })) {
    at_rest.push_back(std::move(piece));
    return;
  }
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    if (!moves[b]) continue;
    end_rest((b > 0 ? b - 1 : 0) * length);
    from = std::max(from, (b + 2) * length);
  }
  end_rest(piece.readings.size());
}

/// Of a column with few different readings; 0 where they are many.
double resolution_of(const std::vector<double>& readings) {
  std::vector<double> some(readings.begin(), readings.begin() + static_cast<std::ptrdiff_t>(
                                                                    std::min(readings.size(), kReadingsForResolution)));
  std::sort(some.begin(), some.end());
  some.erase(std::unique(some.begin(), some.end()), some.end());
  if (some.size() < 2 || 4 * some.size() > std::min(readings.size(), kReadingsForResolution)) return 0.0;
  double least = some.back() - some.front();
  for (std::size_t k = 1; k < some.size(); ++k) least = std::min(least, some[k] - some[k - 1]);
  return least;
}

bool all_alike(const std::vector<double>& readings) {
  return std::all_of(readings.begin(), readings.end(),
                     [&](double y) { return std::fabs(y - readings.front()) < 1.0 / kLargest; });
}

}  // namespace

const char* to_string(BreakCode code) noexcept {
  switch (code) {
    case BreakCode::gap: return "gap";
    case BreakCode::silent: return "silent";
    case BreakCode::motion: return "motion";
  }
  return "?";
}

const char* to_string(Refused refused) noexcept {
  switch (refused) {
    case Refused::no: return "no";
    case Refused::constant: return "constant";
    case Refused::too_short: return "too_short";
    case Refused::no_rate: return "no_rate";
  }
  return "?";
}

Stretch longest_stretch(const StillLog& log, std::size_t column) {
  Stretch out;
  const std::vector<double>& readings = log.columns[column].readings;
  out.rows = readings.size();
  out.refused = Refused::too_short;
  if (readings.size() < 2) return out;
  find_period(log, out);
  if (!(out.period_s >= kShortestPeriod_s && out.period_s <= kLongestPeriod_s)) {
    out.refused = Refused::no_rate;
    return out;
  }
  std::vector<Piece> pieces = even_pieces(log, readings, out);
  const std::size_t length = static_cast<std::size_t>(
      std::clamp(kBlock_s / out.period_s, static_cast<double>(kShortestBlock), static_cast<double>(kLongestRestBlock)));
  std::vector<std::vector<RestBlock>> blocks;
  blocks.reserve(pieces.size());
  for (const Piece& piece : pieces) blocks.push_back(blocks_of(piece, length));
  const Usual usual = usual_of(blocks, length);
  std::vector<Piece> at_rest;
  for (std::size_t p = 0; p < pieces.size(); ++p)
    cut_at_motion(std::move(pieces[p]), blocks[p], length, usual, out, at_rest);
  const auto longest = std::max_element(at_rest.begin(), at_rest.end(), [](const Piece& a, const Piece& b) {
    return a.readings.size() < b.readings.size();
  });
  if (longest == at_rest.end() || longest->readings.empty()) return out;
  out.begin_s = longest->begin_s;
  out.filled = longest->filled;
  out.readings = std::move(longest->readings);
  if (out.readings.size() >= kLeastReadings) out.refused = all_alike(out.readings) ? Refused::constant : Refused::no;
  if (out.refused == Refused::no) out.resolution = resolution_of(out.readings);
  return out;
}

}  // namespace noise
}  // namespace PLUMB_ABI
}  // namespace plumb
