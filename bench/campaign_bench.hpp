/// The campaign that is measured, for sources of every capacity: a plan knows none.
#pragma once

#include <string>

#include "plumb/campaign/plan.hpp"

namespace plumb_bench {

/// One combination: four sensors (more on a cone), random attitudes, 8 stations of 32 samples.
plumb::campaign::Plan campaign_plan(int sensors, const std::string& fault);

}  // namespace plumb_bench
