// The parameters of plumb's fit in the form of eqs (1)-(3), derived from the rest of the calibration file.
#include "calibration_json.hpp"
#include "plumb/io/file_error.hpp"
#include "plumb/paper/paper_parameters.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace io {

Json from_paper_parameters(const SensorArray& nominal, const Calibration& calibration) {
  const Expected<SensorModel> form = paper_form(nominal, calibration.array, calibration.model);
  if (!form) return object({{"why_not", from_error(form.error()).what}});
  Json sensors = Json::array();
  for (int i = 0; i < form->size; ++i) {
    const SensorCoefficients& c = form->sensor[static_cast<std::size_t>(i)];
    Json row = Json::array();
    for (int k = 0; k < form->size; ++k)
      row.push_back(from_double(form->misalignment[static_cast<std::size_t>(i * kCapacity + k)]));
    sensors.push_back(object({{"id", nominal.row(i).id.data()},
                              {"B_mps2", from_array(c.bias, 4)},
                              {"SF_per_mps2", from_array(c.scale, 4)},
                              {"m", row}}));
  }
  return object({{"equations", "(I - M)(V/SF - B) = H g, nominal H, powers of T - reference_degc"},
                 {"sensors", std::move(sensors)}});
}

}  // namespace io
}  // namespace PLUMB_ABI
}  // namespace plumb
