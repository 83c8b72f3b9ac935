#include "records.hpp"

#include <cmath>
#include <iterator>

#include "plumb/io/hash.hpp"

namespace plumb_web {

std::uint64_t decisions_of(const std::vector<double>& records) {
  constexpr At kDecided[] = {At::state,       At::validity,       At::cause,
                             At::decided_by,  At::in_service,     At::provisionally_excluded,
                             At::excluded,    At::absent,         At::suspects,
                             At::event,       At::from,           At::to,
                             At::event_cause, At::event_sensors,  At::hypotheses,
                             At::on_record,   At::paper_state,    At::paper_validity,
                             At::paper_out,   At::paper_suspects, At::px4_selector,
                             At::px4_voter,   At::px4_in_use};
  std::uint64_t sum = plumb::io::kFnvStart;
  for (std::size_t at = 0; at < records.size(); at += record_names().size()) {
    for (const At one : kDecided) {
      const double figure = records[at + static_cast<std::size_t>(one)];
      const std::int64_t whole = std::isfinite(figure) ? static_cast<std::int64_t>(figure) : -2;  // no figure
      sum = plumb::io::fnv1a(&whole, sizeof whole, sum);
    }
  }
  return sum;
}

namespace {

/// In the order of `At`.
constexpr const char* kNames[] = {"time_s",
                                  "station",
                                  "moving",
                                  "state",
                                  "validity",
                                  "cause",
                                  "qualifiers",
                                  "decided_by",
                                  "statistic",
                                  "limit",
                                  "in_service",
                                  "provisionally_excluded",
                                  "excluded",
                                  "absent",
                                  "suspects",
                                  "faulty",
                                  "event",
                                  "from",
                                  "to",
                                  "event_cause",
                                  "event_sensors",
                                  "error_rad",
                                  "plain_rad",
                                  "protection_rad",
                                  "told_x",
                                  "told_y",
                                  "told_z",
                                  "true_x",
                                  "true_y",
                                  "true_z",
                                  "hypotheses",
                                  "on_record",
                                  "parity",
                                  "parity_limit",
                                  "mae_mps2",
                                  "mae_limit_mps2",
                                  "norm_error",
                                  "wants_turn",
                                  "confirmed_grade",
                                  "provisional_grade",
                                  "tick",
                                  "alert",
                                  "paper_state",
                                  "paper_validity",
                                  "paper_out",
                                  "paper_suspects",
                                  "paper_error_rad",
                                  "paper_statistic",
                                  "px4_selector",
                                  "px4_voter",
                                  "px4_in_use",
                                  "px4_error_rad",
                                  "force_error_mps2",
                                  "force_bound_mps2",
                                  "plain_force_mps2",
                                  "px4_force_mps2",
                                  "isolated"};
static_assert(std::size(kNames) == kCommonFigures);

}  // namespace

const std::vector<std::string>& record_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out(std::begin(kNames), std::end(kNames));
    for (int i = 1; i <= plumb::kCapacity; ++i) out.push_back("minimum_faults_" + std::to_string(i));
    return out;
  }();
  return names;
}

}  // namespace plumb_web
