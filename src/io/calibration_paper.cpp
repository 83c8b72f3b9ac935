// The section of a calibration file that holds the fits by the paper's method.
#include <cmath>
#include <vector>

#include "calibration_source.hpp"
#include "plumb/core/units.hpp"
#include "plumb/io/calibration_file.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {
namespace {

std::vector<int> members(SensorSet set) {
  std::vector<int> out;
  for (int i = 0; i < kCapacity; ++i) {
    if (set.has(i)) out.push_back(i);
  }
  return out;
}

/// What the fit changed; sensors that it does not use stand in the array file.
Json from_fit(const PaperFit& fit, const SensorArray& array) {
  Json scale = Json::array(), bias = Json::array(), misalignment = Json::array();
  const std::vector<int> used = members(fit.used);
  for (const int i : used) {
    const auto a = static_cast<std::size_t>(i);
    scale.push_back(from_array(fit.model.sensor[a].scale, 4));
    bias.push_back(from_array(fit.model.sensor[a].bias, 4));
    Json row = Json::array();
    for (const int j : used)
      row.push_back(from_double(fit.model.misalignment[a * kCapacity + static_cast<std::size_t>(j)]));
    misalignment.push_back(std::move(row));
  }
  return object({{"used", ids_of(fit.used, array)},
                 {"converged", fit.converged},
                 {"stop", to_string(fit.stop)},
                 {"iterations", fit.iterations},
                 {"rank", fit.rank},
                 {"start_cost_m4ps8", from_double(fit.start_cost)},
                 {"cost_m4ps8", from_double(fit.cost)},
                 {"scale", std::move(scale)},
                 {"bias_mps2", std::move(bias)},
                 {"misalignment", std::move(misalignment)}});
}

PaperFit fit_from(const Source& source, const Json& object, const std::string& name, SensorSet expected,
                  const ArrayFile& array) {
  const Json wanted = ids_of(expected, array.array);
  if (source.member(object, "used") != wanted) {
    source.fail(source.line_of("paper", "\"used\": " + object["used"].dump()), name + ".used",
                "is " + object["used"].dump() + ", must be " + wanted.dump(), kMakeAnew);
  }
  PaperFit fit;
  fit.used = expected;
  fit.model = array.datasheet.model();
  const Json& converged = source.member(object, "converged");
  if (!converged.is_boolean()) source.fail(0, name + ".converged", "must be true or false", kMakeAnew);
  fit.converged = converged.get<bool>();
  fit.stop = enum_from(source, object, "stop",
                       {StopReason::none, StopReason::converged, StopReason::iteration_limit, StopReason::no_descent,
                        StopReason::not_finite});
  fit.iterations = source.whole_of<int>(object, "iterations");
  fit.rank = source.whole_of<int>(object, "rank");
  fit.start_cost = source.number_of(object, "start_cost_m4ps8");
  fit.cost = source.number_of(object, "cost_m4ps8");
  if (fit.iterations < 0) source.fail(0, name + ".iterations", "is negative", kMakeAnew);
  if (fit.rank < 0) source.fail(0, name + ".rank", "is negative", kMakeAnew);
  if (fit.sound() && !(fit.cost >= 0.0 && std::isfinite(fit.cost)))
    source.fail(0, name + ".cost_m4ps8", "is " + shortest(fit.cost) + ", must be 0 or more", kMakeAnew);
  const std::vector<int> used = members(expected);
  const Json& scale = source.list(source.member(object, "scale"), name + ".scale", used.size());
  const Json& bias = source.list(source.member(object, "bias_mps2"), name + ".bias_mps2", used.size());
  const Json& misalignment = source.list(source.member(object, "misalignment"), name + ".misalignment", used.size());
  for (std::size_t p = 0; p < used.size(); ++p) {
    const auto a = static_cast<std::size_t>(used[p]);
    source.numbers(scale[p], name + ".scale", fit.model.sensor[a].scale.data(), 4);
    source.numbers(bias[p], name + ".bias_mps2", fit.model.sensor[a].bias.data(), 4);
    source.list(misalignment[p], name + ".misalignment", used.size());
    for (std::size_t q = 0; q < used.size(); ++q) {
      const auto b = static_cast<std::size_t>(used[q]);
      fit.model.misalignment[a * kCapacity + b] = source.number(misalignment[p][q], name + ".misalignment");
    }
  }
  return fit;
}

/// Fits of one recording differ by misfit and by a rotation of the frame of a few degrees; beyond these it is not one
/// recording.
constexpr double kMostLength = 0.02;  // of gravity, rms over the directions
constexpr double kMostTurn_rad = rad_from_deg(15.0);

/// Directions to compare in: the axes and the corners of a cube, both ways.
std::vector<Vec3> directions() {
  std::vector<Vec3> out;
  for (const double x : {-1.0, 0.0, 1.0}) {
    for (const double y : {-1.0, 0.0, 1.0}) {
      for (const double z : {-1.0, 0.0, 1.0}) {
        const double length = std::sqrt(x * x + y * y + z * z);
        if (length > 0.0) out.push_back(scaled(Vec3{x, y, z}, 1.0 / length));
      }
    }
  }
  return out;
}

void check_fit(const Source& source, const std::string& name, const PaperFit& fit, const Calibration& calibration,
               const ArrayFile& array, double temperature_degc) {
  double square = 0.0, most_rad = 0.0;
  const std::vector<Vec3> all = directions();
  for (const Vec3& u : all) {
    Readings felt{};
    for (int i = 0; i < calibration.array.size(); ++i)
      felt[static_cast<std::size_t>(i)] = kG0_mps2 * dot(calibration.array.axis(i), u);
    const Expected<std::array<double, kCapacity>> raw = calibration.model.raw_from(felt, temperature_degc);
    const Vec3 x = raw ? paper_vector(array.array, fit, *raw, temperature_degc) : Vec3{};
    const double off = norm(x) / kG0_mps2 - 1.0;
    square += off * off / static_cast<double>(all.size());
    most_rad = std::fmax(most_rad, angle_between_rad(x, u));
  }
  const int line = source.line_of("paper", "\"used\"");
  const std::string remedy = std::string(kMakeAnew) + " (with --paper)";
  // Written so that a NaN is refused too.
  if (!(std::sqrt(square) <= kMostLength)) {
    source.fail(line, name,
                "contradicts the calibration in the same file: gravity differs by " +
                    brief(100.0 * std::sqrt(square), 3) + " % (rms over all directions, " + brief(100.0 * kMostLength) +
                    " % allowed)",
                remedy);
  }
  if (!(most_rad <= kMostTurn_rad)) {
    source.fail(line, name,
                "contradicts the calibration in the same file: the direction of gravity differs by " +
                    brief(deg_from_rad(most_rad), 3) + " deg (" + brief(deg_from_rad(kMostTurn_rad)) + " deg allowed)",
                remedy);
  }
}

}  // namespace

void check_paper(const Source& source, const PaperCalibration& paper, const Calibration& calibration,
                 const ArrayFile& array) {
  const FitReport& report = calibration.report;
  for (const double t : {report.temperature_min_degc, report.temperature_max_degc}) {
    if (paper.all.sound()) check_fit(source, "paper.all", paper.all, calibration, array, t);
    for (int k = 0; k < paper.triples; ++k) {
      const PaperFit& fit = paper.triple[static_cast<std::size_t>(k)];
      // One that is not sound has no say.
      if (fit.sound()) check_fit(source, "paper.triples[" + std::to_string(k + 1) + "]", fit, calibration, array, t);
    }
  }
}

Json from_paper(const PaperCalibration& paper, const SensorArray& array) {
  Json triples = Json::array();
  for (int k = 0; k < paper.triples; ++k) triples.push_back(from_fit(paper.triple[static_cast<std::size_t>(k)], array));
  return object(
      {{"version", kPaperSectionVersion}, {"all", from_fit(paper.all, array)}, {"triples", std::move(triples)}});
}

std::shared_ptr<const PaperCalibration> read_paper(const Source& source, const Json& section, const ArrayFile& array) {
  const Json& version = source.member(section, "version");
  if (version != kPaperSectionVersion) {
    source.fail(source.line_of("paper", "\"version\""), "paper.version",
                "is " + version.dump() + ", this plumb reads version " + std::to_string(kPaperSectionVersion),
                "run plumb calibrate --paper again with this plumb");
  }
  if (array.array.size() > kPaperCapacity) {
    source.fail(source.line_of("paper", "\"version\""), "paper",
                "belongs to an array of " + std::to_string(array.array.size()) +
                    " sensors, but the paper's fit supports at most " + std::to_string(kPaperCapacity),
                kMakeAnew);
  }
  auto out = std::make_shared<PaperCalibration>();
  out->all = fit_from(source, source.member(section, "all"), "paper.all", array.array.all(), array);
  out->triples = array.array.triple_count();
  const Json& triples =
      source.list(source.member(section, "triples"), "paper.triples", static_cast<std::size_t>(out->triples));
  for (int k = 0; k < out->triples; ++k) {
    const auto t = static_cast<std::size_t>(k);
    out->triple[t] = fit_from(source, triples[t], "paper.triples[" + std::to_string(k + 1) + "]",
                              array.array.triple(k).set(), array);
  }
  return out;
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
