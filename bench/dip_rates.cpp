// plumb_dip_rates WHAT [--trials N] [--seed S]: how often one faulty accelerometer of three is found by the length of
// gravity alone and by length and dip, with 95 % Clopper-Pearson intervals, as Markdown. WHAT is detection, stations,
// bound, interference or sizes. docs/isolation.md holds what it printed.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "plumb/study/proportion.hpp"
#include "support/dip_scene.hpp"

namespace {

using namespace plumb;
using plumb_test::DipScene;
using plumb_test::Noise;

struct Run {
  std::uint64_t trials = 20000, seed = 20180227;
};

/// "99.87 [99.79, 99.92]", percent.
std::string share(std::uint64_t k, std::uint64_t n) {
  const study::Proportion p = study::proportion(k, n);
  return study::rounded_share(p, 4, 100.0) + " " + study::interval_text(p, 4, 100.0);
}

/// Three axes: a triad at right angles, or any of |det| 0.3 and more.
SensorArray drawn_array(bool triad, Noise& noise) {
  AxisList axes{};
  if (triad) {
    orthogonal_triad(axes);
  } else {
    axes = plumb_test::random_axes(3, 0.3, noise);
  }
  return plumb_test::sensors_along(axes, 3);
}

/// Normal errors: one sigma of what is stated as sigma; beyond `sigmas` of it where chance has it so.
double normal_error(const DipScene& scene, Noise& noise) { return noise.normal() / scene.stated.sigmas; }

struct Episode {
  DipScene scene;
  int faulty = 0;
  double f_mps2 = 0.0;
};

/// A bias of log-uniform size between `least` and `most` g0, of either sign.
Episode drawn(bool triad, double dip_deg, double least_g, double most_g, Noise& noise) {
  Episode e;
  e.scene = DipScene::make(drawn_array(triad, noise), dip_deg);
  e.scene.settle([&] { return normal_error(e.scene, noise); });
  e.faulty = static_cast<int>(3.0 * noise.uniform());
  e.f_mps2 = least_g * std::pow(most_g / least_g, noise.uniform()) * kG0_mps2 * (noise.uniform() < 0.5 ? -1.0 : 1.0);
  return e;
}

DipStation station(const Episode& e, const Vec3& down, Noise& noise) {
  return e.scene.station(down, e.faulty, e.f_mps2, noise, [&] { return normal_error(e.scene, noise); });
}

/// The same station for which the dip tells nothing.
DipStation by_length_alone(DipStation s) {
  s.reference.dip_error_rad.bound = kPi;
  return s;
}

struct Count {
  std::uint64_t trials = 0, by_length = 0, seen = 0, named = 0, wrong = 0, beyond = 0;

  void add(const DipAnswer& answer, bool length_sees, int faulty, const Vec3& down) {
    ++trials;
    if (length_sees) ++by_length;
    if (answer.verdict == DipVerdict::fault || answer.verdict == DipVerdict::unexplained) ++seen;
    if (answer.named == faulty && faulty >= 0) ++named;
    if (answer.named >= 0 && answer.named != faulty) ++wrong;
    if (angle_between_rad(answer.gravity_mps2, down) > answer.bound_rad) ++beyond;
  }
  void print(const std::string& lead) const {
    std::printf("| %s | %s | %s | %s | %s | %s |\n", lead.c_str(), share(by_length, trials).c_str(),
                share(seen, trials).c_str(), share(named, trials).c_str(), share(wrong, trials).c_str(),
                share(beyond, trials).c_str());
    std::fflush(stdout);
  }
};

void head(const char* first, const char* bars) {
  std::printf("| %s | by length | by length and dip | named | wrong | beyond the bound |\n|%s---|---|---|---|---|\n",
              first, bars);
}

/// One attitude, biases of one size class.
void detection(const Run& settings) {
  head("axes | dip, deg | bias", "---|---|---|");
  const struct {
    const char* name;
    double least_g, most_g;
  } sizes[] = {{"5-20 mg", 0.005, 0.02},
               {"20-100 mg", 0.02, 0.1},
               {"0.1-0.5 g0", 0.1, 0.5},
               {"0.5-2 g0", 0.5, 2.0},
               {"5 mg - 2 g0", 0.005, 2.0}};
  Noise noise(settings.seed);
  for (const bool triad : {true, false}) {
    for (const double dip_deg : {50.0, 72.0}) {
      for (const auto& size : sizes) {
        Count count;
        for (std::uint64_t t = 0; t < settings.trials; ++t) {
          const Episode e = drawn(triad, dip_deg, size.least_g, size.most_g, noise);
          const Vec3 down = plumb_test::random_direction(noise);
          const DipStation s = station(e, down, noise);
          const bool length_sees = !judge_dip(e.scene.array, by_length_alone(s)).none.consistent();
          count.add(DipEvidence().add(judge_dip(e.scene.array, s)), length_sees, e.faulty, down);
        }
        count.print(std::string(triad ? "triad" : "drawn") + " | " + std::to_string(static_cast<int>(dip_deg)) + " | " +
                    size.name);
      }
      Count mirrors;
      for (std::uint64_t t = 0; t < settings.trials; ++t) {
        Episode e = drawn(triad, dip_deg, 0.1, 1.0, noise);
        const Vec3 down = plumb_test::random_direction(noise);
        e.f_mps2 = plumb_test::mirror_fault_mps2(e.scene.array, e.faulty, scaled(down, e.scene.g_mps2));
        const DipStation s = station(e, down, noise);
        const bool length_sees = !judge_dip(e.scene.array, by_length_alone(s)).none.consistent();
        mirrors.add(DipEvidence().add(judge_dip(e.scene.array, s)), length_sees, e.faulty, down);
      }
      mirrors.print(std::string(triad ? "triad" : "drawn") + " | " + std::to_string(static_cast<int>(dip_deg)) +
                    " | mirror");
    }
  }
}

/// A constant bias over several attitudes, by either assumption.
void stations(const Run& settings) {
  head("dip, deg | bias | assumed | attitudes", "---|---|---|---|");
  Noise noise(settings.seed);
  for (const double dip_deg : {50.0, 72.0}) {
    for (const double least_g : {0.005, 0.05}) {
      for (const DipAssumption assumption : {DipAssumption::any_fault, DipAssumption::constant_bias}) {
        constexpr int kStations = 8;
        Count count[kStations + 1];
        for (std::uint64_t t = 0; t < settings.trials; ++t) {
          const Episode e = drawn(true, dip_deg, least_g, least_g * 10.0, noise);
          DipEvidence evidence(assumption);
          bool length_sees = false;
          for (int k = 1; k <= kStations; ++k) {
            const Vec3 down = plumb_test::random_direction(noise);
            const DipStation s = station(e, down, noise);
            length_sees = length_sees || !judge_dip(e.scene.array, by_length_alone(s)).none.consistent();
            count[k].add(evidence.add(judge_dip(e.scene.array, s)), length_sees, e.faulty, down);
          }
        }
        for (const int k : {1, 2, 4, 8}) {
          count[k].print(std::to_string(static_cast<int>(dip_deg)) + " | " +
                         (least_g < 0.01 ? "5-50 mg" : "50-500 mg") + " | " +
                         (assumption == DipAssumption::any_fault ? "any" : "constant") + " | " + std::to_string(k));
        }
      }
    }
  }
}

std::string quantiles(std::vector<double>& values) {
  if (values.empty()) return "-";
  std::sort(values.begin(), values.end());
  const auto at = [&](double p) {
    return deg_from_rad(values[static_cast<std::size_t>(p * static_cast<double>(values.size() - 1))]);
  };
  char text[80];
  std::snprintf(text, sizeof text, "%.1f / %.1f / %.1f", at(0.5), at(0.9), at(0.99));
  return text;
}

/// The bound of the direction: of a healthy triad with and without the dip, and of two sensors and both references.
void bound(const Run& settings) {
  std::printf(
      "| dip, deg | healthy, by length | healthy, by length and dip | one named: of the two others |\n"
      "|---|---|---|---|\n");
  Noise noise(settings.seed);
  for (const double dip_deg : {0.0, 50.0, 72.0, 88.0}) {
    std::vector<double> length, both, named;
    for (std::uint64_t t = 0; t < settings.trials; ++t) {
      Episode e = drawn(true, dip_deg, 0.1, 2.0, noise);
      const Vec3 down = plumb_test::random_direction(noise);
      const DipAnswer broken = DipEvidence().add(judge_dip(e.scene.array, station(e, down, noise)));
      if (broken.named >= 0) named.push_back(broken.bound_rad);
      e.faulty = -1;
      const DipStation s = station(e, down, noise);
      length.push_back(DipEvidence().add(judge_dip(e.scene.array, by_length_alone(s))).bound_rad);
      both.push_back(DipEvidence().add(judge_dip(e.scene.array, s)).bound_rad);
    }
    std::printf("| %.0f | %s | %s | %s |\n", dip_deg, quantiles(length).c_str(), quantiles(both).c_str(),
                quantiles(named).c_str());
  }
}

/// Healthy sensors and an interference of `nt`, in any direction, of which `stated_nt` are stated.
void interference(const Run& settings) {
  std::printf(
      "| interference, nT | stated, nT | refused by the field's length | a fault said | a healthy one named |\n"
      "|---|---|---|---|---|\n");
  Noise noise(settings.seed);
  const struct {
    double nt, stated_nt;
  } cases[] = {{500.0, 0.0},     {1000.0, 0.0},  {2000.0, 0.0},   {5000.0, 0.0},
               {5000.0, 1000.0}, {500.0, 500.0}, {5000.0, 5000.0}};
  for (const auto& c : cases) {
    std::uint64_t refused = 0, said = 0, named = 0;
    for (std::uint64_t t = 0; t < settings.trials; ++t) {
      Episode e = drawn(true, 60.0, 0.1, 1.0, noise);
      e.faulty = -1;
      DipStation s = station(e, plumb_test::random_direction(noise), noise);
      s.field.field_nt = plus(s.field.field_nt, scaled(plumb_test::random_direction(noise), c.nt));
      s.field.vector_nt = c.stated_nt;
      const DipAnswer answer = DipEvidence().add(judge_dip(e.scene.array, s));
      if (answer.verdict == DipVerdict::not_judged) ++refused;
      if (answer.verdict == DipVerdict::fault || answer.verdict == DipVerdict::unexplained) ++said;
      if (answer.named >= 0) ++named;
    }
    std::printf("| %.0f | %.0f | %s | %s | %s |\n", c.nt, c.stated_nt, share(refused, settings.trials).c_str(),
                share(said, settings.trials).c_str(), share(named, settings.trials).c_str());
  }
}

/// The largest mirror fault that both references may miss, and how many of random attitudes have none larger than 1 g0
/// that are missed: with interference of so much stated.
void sizes(const Run& settings) {
  std::printf(
      "| dip, deg | by length | 0 nT | 50 nT | 100 nT | 200 nT | 1 %% | 3 %% |\n|---|---|---|---|---|---|---|---|\n");
  for (const double dip_deg : {0.0, 50.0, 70.0, 88.0}) {
    std::string line = "| " + std::to_string(static_cast<int>(dip_deg));
    for (const double nt : {-1.0, 0.0, 50.0, 100.0, 200.0, 500.0, 1500.0}) {
      Noise noise(settings.seed);
      const DipScene scene = DipScene::make(drawn_array(true, noise), dip_deg);
      std::vector<double> seen;
      for (std::uint64_t t = 0; t < settings.trials; ++t) {
        const Vec3 down = plumb_test::random_direction(noise);
        DipStation s = nt < 0.0 ? by_length_alone(scene.stated) : scene.stated;
        s.field.vector_nt = std::fmax(nt, 0.0);
        s.field.field_nt = scaled(plumb_test::direction_beside(down, 0.5 * kPi - scene.dip_rad, noise), scene.total_nt);
        seen.push_back(surely_seen_mps2(scene.array, s, scaled(down, scene.g_mps2), 0) / kG0_mps2 * 1e3);
      }
      std::sort(seen.begin(), seen.end());
      char text[60];
      std::snprintf(text, sizeof text, " | %.0f / %.0f", seen[seen.size() / 2], seen[seen.size() * 9 / 10]);
      line += text;
    }
    std::printf("%s |\n", line.c_str());
  }
}

int usage() {
  std::fputs("usage: plumb_dip_rates detection|stations|bound|interference|sizes [--trials N] [--seed S]\n", stderr);
  return 2;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) return usage();
  Run settings;
  for (int i = 2; i + 1 < argc; i += 2) {
    const std::string option = argv[i];
    if (option != "--trials" && option != "--seed") return usage();
    (option == "--trials" ? settings.trials : settings.seed) = std::strtoull(argv[i + 1], nullptr, 10);
  }
  if (settings.trials == 0) return usage();
  const std::string what = argv[1];
  if (what == "detection") {
    detection(settings);
  } else if (what == "stations") {
    stations(settings);
  } else if (what == "bound") {
    bound(settings);
  } else if (what == "interference") {
    interference(settings);
  } else if (what == "sizes") {
    sizes(settings);
  } else {
    return usage();
  }
  return 0;
}
