// Any bytes as coefficients of the Earth's field (WMM.COF): what is read gives a finite field at every place and date
// that the model allows.
#include <string_view>

#include "files.hpp"
#include "plumb/geomagnetic/coefficient_file.hpp"
#include "plumb/geomagnetic/field_reference.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace plumb::geomagnetic;
  const std::string text(data, data + size);
  const plumb::io::FileExpected<FieldModel> model = parse_coefficients(text, "fuzz.cof");
  if (!model) {
    fuzz::demand_told(model.error());
    return 0;
  }
  for (const Place place :
       {Place{60.4, 2.1, 25.0}, Place{90.0, 0.0, 0.0}, Place{-90.0, 180.0, -15000.0}, Place{0.0, -180.0, 850000.0}}) {
    const plumb::io::FileExpected<EarthField> field = field_at(*model, place, model->epoch_year + 1.0);
    if (!field) {
      fuzz::demand_told(field.error());
      continue;
    }
    const FieldReference reference = reference_of(*field, iscwsa_errors());
    fuzz::demand(std::isfinite(reference.total_tesla) && reference.total_tesla >= 0.0, "the field has a length");
    fuzz::demand(std::isfinite(reference.dip_rad + reference.declination_rad), "its angles are finite");
    fuzz::demand(reference.dip_rad_sigma.common > 0.0 && reference.declination_rad_sigma.common > 0.0, "sigmas");
  }
  return 0;
}
