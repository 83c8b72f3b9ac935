// Any text as a file of known coefficients: parameters of autopilots, imu_tk, tables. The first byte names a form, or
// none, and what is taken becomes a calibration file that can be read again.
#include <array>

#include "files.hpp"
#include "plumb/coefficients/adoption.hpp"
#include "plumb/coefficients/calibration_export.hpp"

namespace {

namespace pc = plumb::coefficients;

/// Three axes of one chip, in m/s^2, with a temperature.
const plumb::io::ArrayFile& triad() {
  static const plumb::io::ArrayFile array = [] {
    std::string text =
        "[gravity]\nmodel = \"value\"\nvalue = \"9.81 m/s^2\"\n[input]\nreads = \"specific-force\"\nunit = \"m/s^2\"\n"
        "time = \"t\"\ntemperature = \"temp\"\n";
    const std::array<const char*, 3> axes = {"[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"};
    for (std::size_t k = 0; k < 3; ++k)
      text += std::string("[[sensor]]\nid = \"") + "xyz"[k] +
              "1\"\npackage = \"imu1\"\nnoise = \"1 mg\"\naxis = " + axes[k] + "\n";
    auto read = plumb::io::parse_array_text(text, "array.toml");
    fuzz::demand(read.has_value(), "the array can be read");
    return std::move(*read);
  }();
  return array;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::size_t kind = data[0] % (pc::kForms.size() + 1);
  const auto form = kind < pc::kForms.size() ? std::optional<pc::Form>(pc::kForms[kind]) : std::nullopt;
  const std::string text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const auto file = pc::parse_coefficients(text, "known", triad(), form);
  if (!file) {
    fuzz::demand_told(file.error());
    return 0;
  }
  pc::AdoptionChoice choice;
  choice.usual = {0.05, 1e-3, 0.01};
  const auto adopted = pc::adopt(triad(), {*file}, choice);
  if (!adopted) {
    fuzz::demand_told(adopted.error());
    return 0;
  }
  plumb::io::CalibrationContext context;
  context.coefficients = adopted->forms;
  context.gravity = triad().gravity;
  const std::string json = plumb::io::calibration_json(adopted->calibration, triad(), context);
  const fuzz::MemoryFile written(reinterpret_cast<const std::uint8_t*>(json.data()), json.size());
  const auto read = plumb::io::read_calibration(written.path(), triad());
  fuzz::demand(read.has_value(), "what was taken can be read as a calibration");
  for (const pc::Form to : pc::kForms) {
    const auto made = pc::export_calibration(triad(), *read, to);
    if (!made) {
      fuzz::demand_told(made.error());
      continue;
    }
    const auto again = pc::parse_coefficients(made->text, "again", triad(), to);
    fuzz::demand(again.has_value(), "what was written can be read");
  }
  return 0;
}
