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

constexpr const char* kInsteadOfGroup =
    "plumb geometry {} has the least faults that it is sure to find, and plumb simulate with plumb monitor --group "
    "plays "
    "faults against it";

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
  if (!take(read_accelerometers(options.array, "plumb verify", kInsteadOfGroup), out.array, error)) return fail();
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
  for (const auto& [role, path] : {std::pair<const char*, const std::string&>{"array", options.array},
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
