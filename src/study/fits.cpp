#include "plumb/study/fits.hpp"

#include "plumb/scenario/library.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace study {
namespace {

constexpr int kSensors = 4;

tl::unexpected<std::string> refused(const std::string& what, const Error& error) {
  return tl::unexpected<std::string>(what + ": " + describe(error.code) + ". Remedy: " + remedy(error.code));
}

}  // namespace

std::vector<SensorSet> Fits::combinations() const {
  std::vector<SensorSet> out = {nominal.all()};
  for (int k = 0; k < nominal.triple_count(); ++k) out.push_back(nominal.triple(k).set());
  return out;
}

const PaperFit& Fits::paper_fit(SensorSet used) const noexcept {
  for (int k = 0; k < paper->triples; ++k) {
    const PaperFit& fit = paper->triple[static_cast<std::size_t>(k)];
    if (fit.used == used) return fit;
  }
  return paper->all;
}

StudyExpected<std::vector<Station>> calibration_stations(const scenario::Tool& tool, std::uint64_t seed) {
  const StudyExpected<Survey> survey = record(scenario::calibration_run(tool, seed));
  if (!survey) return tl::unexpected<std::string>(survey.error());
  return stations_of(*survey);
}

StudyExpected<Fits> fit_both(const Datasheet& datasheet, const std::vector<Station>& stations,
                             std::vector<PaperTrace>* traces) {
  if (datasheet.size != kSensors) {
    return tl::unexpected<std::string>("the study needs four sensors, but the datasheet has " +
                                       std::to_string(datasheet.size) + ". Remedy: give it the paper's tool");
  }
  const plumb::Expected<SensorArray> nominal = datasheet.array();
  if (!nominal) return refused("the datasheet", nominal.error());
  Fits out;
  out.datasheet = datasheet;
  out.nominal = *nominal;
  const int count = static_cast<int>(stations.size());
  auto paper = std::make_unique<PaperCalibration>();
  paper->triples = nominal->triple_count();
  const std::vector<SensorSet> sets = out.combinations();
  if (traces != nullptr) traces->assign(sets.size(), PaperTrace{});
  for (std::size_t k = 0; k < sets.size(); ++k) {
    PaperFit& fit = k == 0 ? paper->all : paper->triple[k - 1];
    const plumb::Expected<void> done = paper_calibrate(datasheet, study_gravity(), stations.data(), count, sets[k], {},
                                                       fit, traces == nullptr ? nullptr : &(*traces)[k]);
    if (!done) return refused("the paper's fit of " + name_of(sets[k]), done.error());
  }
  const plumb::Expected<Calibration> own = calibrate(datasheet, study_gravity(), stations.data(), count);
  if (!own) return refused("plumb's fit", own.error());
  out.paper = std::move(paper);
  out.own = std::make_unique<const Calibration>(*own);
  return out;
}

std::string name_of(SensorSet used) {
  std::string out;
  for (int i = 0; i < kCapacity; ++i) {
    if (used.has(i)) out += (out.empty() ? "" : "-") + std::to_string(i + 1);
  }
  return out;
}

}  // namespace study
}  // namespace PLUMB_ABI
}  // namespace plumb
