#include "plumb/session/played_log.hpp"

#include "plumb/findings/best_turn.hpp"
#include "plumb/io/log_writer.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace session {

io::FileExpected<std::vector<scenario::Truth>> write_log(const std::string& path, const io::ArrayFile& array,
                                                         const scenario::Scenario& scenario) {
  tl::expected<scenario::Simulator, std::string> simulator = scenario::Simulator::make(scenario);
  if (!simulator) {
    return tl::unexpected<io::FileError>(
        io::FileError{path, 0, "", simulator.error(), "report this as a bug of plumb", io::ExitCode::other});
  }
  io::FileExpected<io::LogWriter> writer = io::LogWriter::create(path, array);
  if (!writer) return tl::unexpected<io::FileError>(writer.error());
  std::vector<scenario::Truth> truth;
  Sample sample;
  while (simulator->next(sample)) {
    const io::FileExpected<void> written = writer->write(sample);
    if (!written) return tl::unexpected<io::FileError>(written.error());
    truth.push_back(simulator->truth());
  }
  const io::FileExpected<void> kept = writer->commit();
  if (!kept) return tl::unexpected<io::FileError>(kept.error());
  return truth;
}

void into_frame_of_nominal_axes(const scenario::Tool& tool, std::vector<scenario::Truth>& truth) {
  findings::BestTurn best;
  for (int i = 0; i < tool.datasheet.size; ++i) {
    const auto a = static_cast<std::size_t>(i);
    best.add(tool.datasheet.sensor[a].row.axis, tool.axes[a]);
  }
  const findings::Turn turn = best.find(findings::Hand::kept);
  for (scenario::Truth& t : truth) t.gravity_mps2 = findings::turned(turn, t.gravity_mps2);
}

}  // namespace session
}  // namespace PLUMB_ABI
}  // namespace plumb
