/// The first page of a report: what somebody signs (private to src/render). It fits on one sheet.
#pragma once

#include <string>
#include <vector>

#include "html_view.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

struct SignOff {
  std::string verdict, tone;        ///< the sentence; "good", "bad" or "open"
  std::vector<ViewFigure> answers;  ///< six
  ViewRows identity;                ///< what, and what it is
  std::string run;                  ///< when and where, which differs from run to run
};

/// Verdict, answers, identity, run and lines to sign on; its anchor is "signoff".
Section sign_off_view(const SignOff& content);

/// The rows of an identity for the files that were read: role, then name and hash.
void add_inputs(const Json& inputs, ViewRows& out);
/// "sha256 ..." or, of what was read as a stream, "fnv1a ...".
std::string hash_of(const Json& input);
/// "unknown" for a text that is not there.
std::string told(const Json& text);

/// The sign-off of a health report.
Section health_sign_off(const Json& report);
/// The sign-off of a verification report.
Section verification_sign_off(const Json& report);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
