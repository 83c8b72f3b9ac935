/// Why a run of the monitor judged nothing, and what to do about that.
#pragma once

#include "plumb/findings/nothing_judged.hpp"
#include "plumb/render/fit_report.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace render {

Refusal nothing_judged_words(const findings::NothingJudgedStudy& study, const io::ArrayFile& array);

}  // namespace render
}  // namespace PLUMB_ABI
}  // namespace plumb
