#include "records.hpp"

namespace plumb_web {

const std::vector<std::string>& record_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> out = {"time_s",
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
                                    "px4_force_mps2"};
    for (int i = 1; i <= plumb::kCapacity; ++i) out.push_back("minimum_faults_" + std::to_string(i));
    return out;
  }();
  return names;
}

}  // namespace plumb_web
