#include "plumb/session/stepper.hpp"

#include "plumb/session/detail/step_rows.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace stepping_detail {

using stepping::Rows;
using stepping::Said;
using stepping::Wanted;

namespace {

class Steps final : public stepping::Stepper {
 public:
  bool configure(const std::vector<std::uint8_t>& bytes);
  void step(const Rows& rows, bool first, Wanted wanted, Said& said) override;
  void now(std::vector<std::uint8_t>& bytes) const override { pack(monitor_.verdict(), bytes); }
  int capacity() const noexcept override { return kCapacity; }

 private:
  HealthMonitor monitor_;
  RunCounter counter_;
};

bool Steps::configure(const std::vector<std::uint8_t>& bytes) {
  auto setup = std::make_unique<MonitorSetup>();
  auto uncertainty = std::make_unique<RowUncertainty>();
  std::array<SensorRow, kCapacity> rows{};
  Unpacker unpacker(bytes.data());
  lead(unpacker, *setup, rows, *uncertainty);
  const Expected<SensorArray> array = SensorArray::make(rows.data(), setup->model.size);
  if (!array) return false;
  setup->array = *array;
  setup->array.set_uncertainty(*uncertainty);
  return monitor_.configure(*setup).has_value();
}

void Steps::step(const Rows& rows, bool first, Wanted wanted, Said& said) {
  step_rows(monitor_, rows, first, wanted, counter_, said, [](double) {});
}

}  // namespace

/// The stepper of this capacity. Null where the setup does not fit: too many sensors, too long a window.
std::unique_ptr<stepping::Stepper> make(const std::vector<std::uint8_t>& setup) {
  auto steps = std::make_unique<Steps>();
  if (!steps->configure(setup)) return nullptr;
  return steps;
}

}  // namespace stepping_detail
}  // namespace PLUMB_ABI
}  // namespace plumb
