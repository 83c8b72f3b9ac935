// plumb_motion_rates WHAT [--flights N] [--seed S] [--jobs J] [--kind KIND] [--layout N]: what a motion monitor finds
// in simulated flights, how fast, how often wrong, as Markdown with 95 % Clopper-Pearson intervals. WHAT is
//   healthy  false alarms, bounds and their slack, by what flies and by the number of sensors
//   faults   detection and isolation by fault and number of sensors
//   chips    the same of three and two parallel triads, whole chips failing
//   gyro     a gyro that fails, alone and one of two: who is blamed
//   triads   one of three gyro triads fails: who is blamed, and whether an accelerometer that fails is found all the
//   same beyond   true errors of 1.5, 2 and 3 times the bounds rivals   three triads, a whole chip failing, judged by
//   the rules of others too, all on the same flights
// docs/motion.md holds what it printed.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <iterator>
#include <string>
#include <vector>

#include "flight_case.hpp"
#include "flight_runs.hpp"
#include "plumb/core/units.hpp"
#include "rivals.hpp"
#include "three_gyros.hpp"

namespace {

using namespace plumb_bench;
using plumb::kG0_mps2;
using plumb::SensorSet;
using plumb::scenario::FlightFault;
using plumb::scenario::FlightFaultKind;
using plumb::scenario::FlightKind;
using plumb::scenario::GyroFault;
using plumb::scenario::GyroFaultKind;

struct Settings {
  std::string what;
  std::uint64_t flights = 100;
  std::uint64_t seed = 1;
  unsigned jobs = 2;
  std::string kind;    ///< of the flights of `healthy` and `beyond`; empty: every kind
  std::string layout;  ///< of their arrays; empty: every one
};

template <class Make>
std::vector<FlightOutcome> fly_all(const Settings& s, Make make) {
  return run_all(s.flights, s.jobs, s.seed * 1000003, [&](std::uint64_t seed) { return fly(make(seed)); });
}

template <class Test>
std::uint64_t count(const std::vector<FlightOutcome>& all, Test test) {
  return static_cast<std::uint64_t>(std::count_if(all.begin(), all.end(), test));
}

/// "3 / 17": median and 99th percentile in ms of those that are not below zero.
std::string times_ms(const std::vector<FlightOutcome>& all, double FlightOutcome::*time) {
  std::vector<double> found;
  for (const FlightOutcome& one : all) {
    if (one.*time >= 0.0) found.push_back(1e3 * (one.*time));
  }
  if (found.empty()) return "-";
  std::sort(found.begin(), found.end());
  const auto at = [&](double p) { return found[static_cast<std::size_t>(p * static_cast<double>(found.size() - 1))]; };
  char text[64];
  std::snprintf(text, sizeof text, "%.0f / %.0f", at(0.5), at(0.99));
  return text;
}

BoundTally sum(const std::vector<FlightOutcome>& all, BoundTally FlightOutcome::*member) {
  BoundTally out;
  for (const FlightOutcome& one : all) {
    const BoundTally& t = one.*member;
    out.checks += t.checks;
    out.violations += t.violations;
    out.bound_sum_mps2 += t.bound_sum_mps2;
    out.square_sum += t.square_sum;
  }
  return out;
}

double mg(double mps2) { return 1e3 * mps2 / kG0_mps2; }

void print_bound(const char* lead, const BoundTally& t) {
  const double checks = t.checks > 0 ? static_cast<double>(t.checks) : 1.0;
  std::printf("%s%llu of %llu | %.1f | %.1f |", lead, static_cast<unsigned long long>(t.violations),
              static_cast<unsigned long long>(t.checks), mg(t.bound_sum_mps2 / checks),
              mg(std::sqrt(t.square_sum / checks)));
}

/// A cone of n sensors, or three parallel triads.
struct Layout {
  const char* name;
  FlightArray array;
  int sensors;
};
constexpr Layout kLayouts[] = {{"4", FlightArray::cone, 4},   {"5", FlightArray::cone, 5},
                               {"6", FlightArray::cone, 6},   {"8", FlightArray::cone, 8},
                               {"12", FlightArray::cone, 12}, {"3 triads", FlightArray::triads, 9}};

void healthy_row(const Settings& s, const FlightCase& like, const char* layout) {
  const auto all = fly_all(s, [&](std::uint64_t seed) {
    FlightCase one = like;
    one.seed = seed;
    return one;
  });
  const auto alarms = count(all, [](const FlightOutcome& o) { return o.early_alarm; });
  const auto blamed = count(all, [](const FlightOutcome& o) { return o.wrongly_isolated || o.wrongly_excluded; });
  std::printf("| %s | %s | %llu | %s | %llu |", to_string(like.kind), layout,
              static_cast<unsigned long long>(s.flights), share(alarms, s.flights).c_str(),
              static_cast<unsigned long long>(blamed));
  print_bound(" ", sum(all, &FlightOutcome::sample));
  print_bound(" ", sum(all, &FlightOutcome::block));
  std::printf("\n");
  std::fflush(stdout);
}

void healthy(const Settings& s, double factor) {
  std::printf(
      "| flight | sensors | flights | alarm, %% | blamed | sample: bound passed | mean bound, mg | rms error, mg | "
      "block: bound passed | mean bound, mg | rms error, mg |\n|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (int kind = 0; kind < plumb::scenario::kFlightKinds; ++kind) {
    if (!s.kind.empty() && s.kind != to_string(static_cast<FlightKind>(kind))) continue;
    for (const Layout& layout : kLayouts) {
      if (!s.layout.empty() && s.layout != layout.name) continue;
      FlightCase like;
      like.kind = static_cast<FlightKind>(kind);
      like.array = layout.array;
      like.sensors = layout.sensors;
      like.error_factor = factor;
      healthy_row(s, like, layout.name);
    }
  }
}

struct Named {
  const char* name;
  FlightFaultKind kind;
  double size;
};
const Named kFaults[] = {{"dead", FlightFaultKind::dead, 0.0},
                         {"stuck", FlightFaultKind::stuck, 0.0},
                         {"0.5 g", FlightFaultKind::bias, 0.5 * kG0_mps2},
                         {"0.1 g", FlightFaultKind::bias, 0.1 * kG0_mps2},
                         {"50 mg", FlightFaultKind::bias, 0.05 * kG0_mps2},
                         {"30 mg", FlightFaultKind::bias, 0.03 * kG0_mps2},
                         {"20 mg", FlightFaultKind::bias, 0.02 * kG0_mps2},
                         {"scale 5 %", FlightFaultKind::scale, 0.05},
                         {"10 ms late", FlightFaultKind::skew, 0.01},
                         {"noise 1 m/s2", FlightFaultKind::noise, 1.0},
                         {"drift 0.1 m/s2 a second", FlightFaultKind::drift, 0.1}};

void row(const char* name, const Settings& s, const FlightCase& like, const std::vector<FlightOutcome>& all) {
  const auto n = s.flights;
  std::printf("| %s | %s | %d | %d | %s | %s | %s | %s | %llu |", name, to_string(like.kind), like.sensors, like.gyros,
              share(count(all, [](const FlightOutcome& o) { return o.detected_s >= 0.0; }), n).c_str(),
              times_ms(all, &FlightOutcome::detected_s).c_str(),
              share(count(all, [](const FlightOutcome& o) { return o.isolated_s >= 0.0; }), n).c_str(),
              times_ms(all, &FlightOutcome::isolated_s).c_str(),
              static_cast<unsigned long long>(
                  count(all, [](const FlightOutcome& o) { return o.wrongly_isolated || o.wrongly_excluded; })));
  print_bound(" ", sum(all, &FlightOutcome::block));
  std::printf("\n");
  std::fflush(stdout);
}

constexpr const char* kHead =
    "| fault | flight | n | gyros | detected, % | p50 / p99, ms | isolated, % | p50 / p99, ms | others blamed | block: "
    "bound "
    "passed | mean bound, mg | rms error, mg |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n";

void faults(const Settings& s) {
  std::printf("%s", kHead);
  for (const Named& fault : kFaults) {
    for (const int n : {4, 5, 6, 8, 12}) {
      FlightCase like;
      like.sensors = n;
      const auto all = fly_all(s, [&](std::uint64_t seed) {
        FlightCase one = like;
        one.seed = seed;
        const double sign = (seed / 2) % 2 == 0 || fault.kind == FlightFaultKind::noise ? 1.0 : -1.0;
        one.faults = {{fault.kind, SensorSet::of(static_cast<int>(seed % static_cast<std::uint64_t>(n))),
                       sign * fault.size, 2.5}};
        return one;
      });
      row(fault.name, s, like, all);
    }
  }
}

/// A whole chip of parallel triads fails, each in its turn.
FlightCase with_chip_fault(const FlightCase& like, const Named& fault, std::uint64_t seed) {
  FlightCase one = like;
  one.seed = seed;
  const auto chip = static_cast<unsigned>(seed % static_cast<std::uint64_t>(one.sensors / 3));
  one.faults = {{fault.kind, SensorSet(7U << (3U * chip)), fault.size, 2.5}};
  return one;
}

void chips(const Settings& s) {
  std::printf("%s", kHead);
  for (const Named& fault : kFaults) {
    for (const int n : {6, 9, 12}) {
      FlightCase like;
      like.array = FlightArray::triads;
      like.sensors = n;
      const auto all = fly_all(s, [&](std::uint64_t seed) { return with_chip_fault(like, fault, seed); });
      row(fault.name, s, like, all);
    }
  }
}

void triads_row(const Settings& s, const char* play, double bias_mps2, int n,
                const std::vector<ThreeGyroOutcome>& all) {
  std::vector<FlightOutcome> forces, gyros;
  std::uint64_t gyro_blamed = 0, checks = 0, violations = 0;
  double share_of_limit = 0.0;
  for (const ThreeGyroOutcome& one : all) {
    forces.push_back(one.accelerometers);
    gyros.emplace_back().isolated_s = one.gyro_isolated_s;
    gyro_blamed += one.gyro_wrongly_isolated ? 1U : 0U;
    checks += one.rate_checks;
    violations += one.rate_violations;
    share_of_limit = std::max(share_of_limit, one.worst_median_share);
  }
  const auto isolated = [](const FlightOutcome& o) { return o.isolated_s >= 0.0; };
  const BoundTally block = sum(forces, &FlightOutcome::block);
  std::printf("| %s | %s | %d | %s | %s | %llu | %s | %s | %llu | %llu of %llu | %llu of %llu | %.0f |\n", play,
              bias_mps2 > 0.0 ? (std::to_string(static_cast<int>(mg(bias_mps2) + 0.5)) + " mg").c_str() : "healthy", n,
              share(count(forces, isolated), s.flights).c_str(), times_ms(forces, &FlightOutcome::isolated_s).c_str(),
              static_cast<unsigned long long>(
                  count(forces, [](const FlightOutcome& o) { return o.wrongly_isolated || o.wrongly_excluded; })),
              share(count(gyros, isolated), s.flights).c_str(), times_ms(gyros, &FlightOutcome::isolated_s).c_str(),
              static_cast<unsigned long long>(gyro_blamed), static_cast<unsigned long long>(block.violations),
              static_cast<unsigned long long>(block.checks), static_cast<unsigned long long>(violations),
              static_cast<unsigned long long>(checks), 100.0 * share_of_limit);
  std::fflush(stdout);
}

void gyro(const Settings& s) {
  std::printf("%s", kHead);
  const struct {
    const char* name;
    GyroFaultKind kind;
    double size;
  } kinds[] = {{"gyro dead", GyroFaultKind::dead, 0.0},
               {"gyro stuck", GyroFaultKind::stuck, 0.0},
               {"gyro scale 2", GyroFaultKind::scale, 1.0},
               {"gyro bias 20 deg/s", GyroFaultKind::bias, plumb::rad_from_deg(20.0)}};
  for (const auto& fault : kinds) {
    for (const int gyros : {1, 2}) {
      for (const int n : {5, 6, 8}) {
        FlightCase like;
        like.sensors = n;
        like.gyros = gyros;
        const auto all = fly_all(s, [&](std::uint64_t seed) {
          FlightCase one = like;
          one.seed = seed;
          one.gyro_faults = {{fault.kind, static_cast<int>(seed % static_cast<std::uint64_t>(gyros)), fault.size, 2.5}};
          return one;
        });
        row(fault.name, s, like, all);
      }
    }
  }
}

/// Three gyro triads, one of which fails; arms of 30 mm. An accelerometer fails a second later, or none does.
void triads(const Settings& s) {
  std::printf(
      "| gyro | accelerometer | n | isolated, %% | p50 / p99, ms | healthy ones blamed | gyro isolated, %% | p50 / "
      "p99, "
      "ms | healthy gyros blamed | force bound passed | rate bound passed | median's error of its limit, %% |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|\n");
  for (int play = 0; play < kGyroPlays; ++play) {
    for (const double bias_mps2 : {0.0, 0.5 * kG0_mps2}) {
      for (const int n : {5, 6, 8}) {
        const auto all = run_all(s.flights, s.jobs, s.seed * 1000003, [&](std::uint64_t seed) {
          ThreeGyroCase one;
          one.play = static_cast<GyroPlay>(play);
          one.flight.sensors = n;
          one.flight.arm_m = one.arm_m;
          one.flight.seed = seed;
          if (bias_mps2 > 0.0)
            one.flight.faults = {{FlightFaultKind::bias,
                                  SensorSet::of(static_cast<int>(seed % static_cast<unsigned>(n))),
                                  (seed / 2) % 2 == 0 ? bias_mps2 : -bias_mps2, 2.5}};
          return fly_three_gyros(one);
        });
        triads_row(s, to_string(static_cast<GyroPlay>(play)), bias_mps2, n, all);
      }
    }
  }
}

/// What each rule makes of the same flights.
using RivalOutcomes = std::vector<std::array<FlightOutcome, kRules>>;

std::vector<FlightOutcome> of_rule(const RivalOutcomes& all, std::size_t rule) {
  std::vector<FlightOutcome> out;
  for (const auto& one : all) out.push_back(one[rule]);
  return out;
}

/// Flights with another seed, on which the tuned limits rest.
TunedLimits tuned_limits(Settings s, const FlightCase& like) {
  ++s.seed;
  TunedLimits out{0.0, 0.0};
  for (const TunedLimits& one : run_all(s.flights, s.jobs, s.seed * 1000003, [&](std::uint64_t seed) {
         FlightCase healthy = like;
         healthy.seed = seed;
         return quiet_limits(healthy);
       })) {
    out.median_mps2 = std::max(out.median_mps2, one.median_mps2);
    out.parity_mps2 = std::max(out.parity_mps2, one.parity_mps2);
  }
  return out;
}

/// "right %; p50 / p99 ms; wrong %". Right: the chip is isolated and no healthy one ever was, nor itself before it
/// failed. A rule that alarms more often than it names says how often.
std::string rival_cell(const std::vector<FlightOutcome>& all) {
  std::vector<FlightOutcome> right;
  std::copy_if(all.begin(), all.end(), std::back_inserter(right), [](const FlightOutcome& o) {
    return o.isolated_s >= 0.0 && !o.wrongly_isolated && !o.wrongly_excluded;
  });
  const auto wrong = count(all, [](const FlightOutcome& o) { return o.wrongly_isolated || o.wrongly_excluded; });
  const auto alarms = count(all, [](const FlightOutcome& o) { return o.early_alarm || o.detected_s >= 0.0; });
  const auto percent = [&](std::uint64_t k) {
    return 100.0 * static_cast<double>(k) / static_cast<double>(all.size());
  };
  char text[128];
  std::snprintf(text, sizeof text, "%.1f; %s; %.1f", percent(right.size()),
                times_ms(right, &FlightOutcome::isolated_s).c_str(), percent(wrong));
  if (alarms == right.size() + wrong) return text;
  char more[64];
  std::snprintf(more, sizeof more, " (alarm %.1f)", percent(alarms));
  return std::string(text) + more;
}

/// Twice as long as the other flights: the slowest rule integrates for seconds.
void rivals(const Settings& s) {
  constexpr std::size_t kCompared = 6;
  FlightCase like;
  like.array = FlightArray::triads;
  like.sensors = 9;
  like.duration_s = 12.0;
  const TunedLimits limits = tuned_limits(s, like);
  std::vector<RivalOutcomes> columns;
  std::printf("| rule | alarms in %llu healthy flights |", static_cast<unsigned long long>(s.flights));
  columns.push_back(run_all(s.flights, s.jobs, s.seed * 1000003, [&](std::uint64_t seed) {
    FlightCase healthy = like;
    healthy.seed = seed;
    return fly_rivals(healthy, limits);
  }));
  for (std::size_t k = 0; k < kCompared; ++k) {
    std::printf(" %s |", kFaults[k].name);
    columns.push_back(run_all(s.flights, s.jobs, s.seed * 1000003, [&](std::uint64_t seed) {
      FlightCase one = with_chip_fault(like, kFaults[k], seed);
      one.faults[0].onset_s += 1e-3 * static_cast<double>(seed % 1000);  // at any time between two looks of a rule
      return fly_rivals(one, limits);
    }));
  }
  std::printf("\n|---|---|---|---|---|---|---|---|\n");
  for (std::size_t rule = 0; rule < static_cast<std::size_t>(kRules); ++rule) {
    const auto healthy = of_rule(columns[0], rule);
    std::printf("| %s | %llu |", kRuleNames[rule],
                static_cast<unsigned long long>(count(healthy, [](const FlightOutcome& o) { return o.early_alarm; })));
    for (std::size_t k = 0; k < kCompared; ++k) std::printf(" %s |", rival_cell(of_rule(columns[k + 1], rule)).c_str());
    std::printf("\n");
  }
  std::printf(
      "\nPer fault of a whole chip: right, %%; p50 / p99, ms; wrong, %%. Right: it is isolated, and no healthy chip "
      "ever "
      "was.\nTuned on %llu healthy flights of seed %llu: median %.1f mg, GLT %.1f mg of parity.\n",
      static_cast<unsigned long long>(s.flights), static_cast<unsigned long long>(s.seed + 1), mg(limits.median_mps2),
      mg(limits.parity_mps2));
}

bool is_kind(const std::string& word) {
  for (int kind = 0; kind < plumb::scenario::kFlightKinds; ++kind) {
    if (word == to_string(static_cast<FlightKind>(kind))) return true;
  }
  return false;
}

bool is_layout(const std::string& word) {
  return std::any_of(std::begin(kLayouts), std::end(kLayouts), [&](const Layout& one) { return word == one.name; });
}

bool read(int argc, char** argv, Settings* out) {
  if (argc < 2) return false;
  out->what = argv[1];
  for (int k = 2; k + 1 < argc; k += 2) {
    const std::string key = argv[k];
    const auto value = static_cast<std::uint64_t>(std::strtoull(argv[k + 1], nullptr, 10));
    if (key == "--flights" && value > 0)
      out->flights = value;
    else if (key == "--seed")
      out->seed = value;
    else if (key == "--jobs" && value > 0)
      out->jobs = static_cast<unsigned>(value);
    else if (key == "--kind" && is_kind(argv[k + 1]))
      out->kind = argv[k + 1];
    else if (key == "--layout" && is_layout(argv[k + 1]))
      out->layout = argv[k + 1];
    else
      return false;
  }
  return argc % 2 == 0;
}

}  // namespace

int main(int argc, char** argv) {
  Settings s;
  if (!read(argc, argv, &s)) {
    std::fprintf(
        stderr,
        "usage: plumb_motion_rates healthy|faults|chips|gyro|triads|beyond|rivals [--flights N] [--seed S] [--jobs J]\n"
        "                          [--kind drone|drilling|car|launch] [--layout 4|5|6|8|12|'3 triads']\n"
        "                          (of healthy and beyond: only these)\n");
    return 2;
  }
  if (s.what == "healthy") {
    healthy(s, 1.0);
  } else if (s.what == "faults") {
    faults(s);
  } else if (s.what == "chips") {
    chips(s);
  } else if (s.what == "gyro") {
    gyro(s);
  } else if (s.what == "triads") {
    triads(s);
  } else if (s.what == "rivals") {
    rivals(s);
  } else if (s.what == "beyond") {
    for (const double factor : {1.5, 2.0, 3.0}) {
      std::printf("\nErrors of %.1f times the bounds\n\n", factor);
      healthy(s, factor);
    }
  } else {
    std::fprintf(stderr, "plumb_motion_rates: WHAT is healthy, faults, chips, gyro, triads, beyond or rivals, not %s\n",
                 argv[1]);
    return 2;
  }
  return 0;
}
