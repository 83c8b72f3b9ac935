/// A block of a tool at rest, without noise and without error: what each axis feels of gravity.
#pragma once

#include "plumb/detection/isolation.hpp"

namespace plumb_test {

inline plumb::BlockEvidence block_at(const plumb::SensorArray& array, const plumb::Vec3& direction) {
  plumb::BlockEvidence block;
  block.usable = array.all();
  block.samples = 32.0;
  for (int i = 0; i < array.size(); ++i) {
    block.mean_mps2[static_cast<std::size_t>(i)] = plumb::dot(array.axis(i), direction) * plumb::kG0_mps2;
  }
  return block;
}

}  // namespace plumb_test
