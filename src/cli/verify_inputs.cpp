#include "verify_inputs.hpp"

#include "known_attitude_option.hpp"
#include "plumb/io/output_file.hpp"
#include "plumb/render/calibration_notes.hpp"
#include "plumb/render/change.hpp"
#include "plumb/render/identity.hpp"
#include "read_array.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {
namespace {

/// Everything that is judged here is judged by the length of the vector, which a rate does not have.
io::FileExpected<io::ArrayFile> read_group(const VerifyOptions& options) {
  io::FileExpected<io::ArrayFile> array = read_array(options.array, "plumb verify", Serves::all);
  if (!array) return array;
  if (array->field == io::FieldKind::rate)
    return tl::unexpected<io::FileError>(io::FileError{
        options.array, 0, "", "plumb verify does not serve a group of gyros: a rate has no length to judge by",
        "plumb geometry " + io::shell_word(options.array) +
            " has the least faults that parity isolates; plumb monitor --group " + array->group +
            " and plumb_rates_step in C watch them, and plumb simulate plays faults against both",
        io::ExitCode::usage});
  if (array->field != io::FieldKind::gravity && !options.known_attitudes.empty())
    return tl::unexpected<io::FileError>(io::FileError{
        "--known-attitude", 0, "",
        "inclination and toolface do not say how the magnetic field lies in the tool: that takes an azimuth as well",
        "give --calibration CAL.json as plumb calibrate --align-by wrote it", io::ExitCode::usage});
  return array;
}

io::FileExpected<void> note_input(const char* role, const std::string& path, VerifyInputs& inputs) {
  if (path.empty()) return {};
  const io::FileExpected<std::string> bytes = io::read_file(path);
  if (!bytes) return tl::unexpected<io::FileError>(bytes.error());
  inputs.files.push_back(render::input_json(role, path, *bytes));
  return {};
}

/// Takes the value of `from`, or keeps its error.
template <class T, class To>
bool take(io::FileExpected<T> from, To& to, std::optional<io::FileError>& error) {
  if (!from) {
    error = from.error();
    return false;
  }
  to = *std::move(from);
  return true;
}

}  // namespace

io::FileExpected<VerifyInputs> read_inputs(const VerifyOptions& options, Verification& out) {
  VerifyInputs inputs;
  std::optional<io::FileError> error;
  const auto fail = [&error] { return tl::unexpected<io::FileError>(*error); };
  if (!take(read_group(options), out.array, error)) return fail();
  take_known_attitudes(options.known_attitudes, out.array);
  inputs.limits = verification::limits_of(out.array);
  if (!options.limits.empty() && !take(verification::read_limits(options.limits, out.array), inputs.limits, error))
    return fail();
  inputs.limits.drift = render::drift_words(out.array, options.days_since_calibration);
  if (!options.test_results.empty() && !take(render::read_test_results(options.test_results), inputs.tests, error))
    return fail();
  if (!options.test_results.empty() && !take(render::read_test_build(options.test_results), inputs.tests_build, error))
    return fail();
  if (!options.assurance.empty() && !take(render::read_assurance(options.assurance), inputs.assurance, error))
    return fail();
  if (!options.analysis.empty() && !take(render::read_analysis(options.analysis), inputs.analysis, error))
    return fail();
  if (!options.resources.empty() && !take(render::read_resources(options.resources), inputs.resources, error))
    return fail();
  if (!options.compare.empty() && !take(render::read_report(options.compare), inputs.before, error)) return fail();
  if (options.traceability.empty()) {
    if (!take(render::parse_traceability(render::built_in_traceability(), "built in"), out.traceability, error))
      return fail();
  } else if (!take(render::read_traceability(options.traceability), out.traceability, error)) {
    return fail();
  }
  const std::string array_file = array_file_of(options.array);
  for (const auto& [role, path] : {std::pair<const char*, const std::string&>{"array", array_file},
                                   {"limits", options.limits},
                                   {"calibration", options.calibration},
                                   {"stations", options.stations},
                                   {"test results", options.test_results},
                                   {"assurance results", options.assurance},
                                   {"traceability", options.traceability},
                                   {"static analysis", options.analysis},
                                   {"resources", options.resources}}) {
    const io::FileExpected<void> noted = note_input(role, path, inputs);
    if (!noted) return tl::unexpected<io::FileError>(noted.error());
  }
  for (const std::string& path : options.reuse) {
    const io::FileExpected<void> noted = note_input("campaign result", path, inputs);
    if (!noted) return tl::unexpected<io::FileError>(noted.error());
  }
  return inputs;
}

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
