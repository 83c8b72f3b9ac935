#include "motion_flight.hpp"

#include "plumb/session/interrupt.hpp"
#include "plumb/session/motion_commissioning.hpp"
#include "plumb/session/progress.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

io::FileExpected<MotionFlight> read_flight(const io::ArrayFile& array, const MotionPlan& plan, const LogSpec& log) {
  io::FileExpected<io::LogReader> reader = io::LogReader::open(log.path, array, log.on_bad_row);
  if (!reader) return tl::unexpected<io::FileError>(reader.error());
  reader->hash_bytes();
  reader->stop_when(interrupt_flag());
  MotionFlight out;
  MotionSampler sampler(plan);
  MotionInputsWatch inputs(plan.setup.sample_period_s);
  Progress progress("reading " + log.path);
  Sample row;
  io::LogReader::Next status = reader->next(row);
  for (; status == io::LogReader::Next::row; status = reader->next(row)) {
    if (out.samples.size() == kMostCommissionRows)
      return tl::unexpected<io::FileError>(
          io::FileError{log.path, 0, "", "has more than " + std::to_string(kMostCommissionRows) + " rows",
                        "cut a part out of it in which the tool turns and accelerates in all directions"});
    MotionSample sample = sampler.sample(row);
    inputs.add(row.time_s);
    const Rotation turns[] = {reader->rotation(), reader->second_rotation()};
    for (std::size_t g = 0; g < static_cast<std::size_t>(plan.setup.gyros); ++g) {
      inputs.add_rate(g, turns[g].rate_known, turns[g].rate_radps);
      sample.rate_given[g] = turns[g].rate_known;
      sample.rate_radps[g] = turns[g].rate_radps;
    }
    out.clipped = out.clipped | sample.clipped;
    out.samples.push_back(sample);
    progress.at(out.samples.size(), row.time_s);
  }
  if (status == io::LogReader::Next::error) return tl::unexpected<io::FileError>(reader->error());
  out.inputs = inputs.found();
  out.log = reader->statistics();
  return out;
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
