/// What `plumb verify` reads.
#pragma once

#include <optional>

#include "plumb/io/json_fields.hpp"
#include "plumb/render/evidence.hpp"
#include "plumb/render/traceability.hpp"
#include "plumb/verification/limits.hpp"
#include "verify_run.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace cli {

/// Everything that is read, before anything is computed.
struct VerifyInputs {
  verification::UserLimits limits;
  std::optional<render::TestResults> tests;
  render::BuildKey tests_build;  ///< of which build those are
  std::optional<render::AssuranceResults> assurance;
  std::optional<io::Json> before;
  std::optional<render::Analysis> analysis;
  std::optional<render::TargetResources> resources;
  io::Json files = io::Json::array();  ///< what the report rests on, hashed
};

/// The array file and the traceability go to `out`.
io::FileExpected<VerifyInputs> read_inputs(const VerifyOptions& options, Verification& out);

}  // namespace cli
}  // namespace PLUMB_ABI
}  // namespace plumb
