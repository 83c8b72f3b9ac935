// An adversary that copies the monitor: it knows the noise of the block to come, tries its lies on copies, and shows
// the one that hurts most.
#pragma once

#include <memory>
#include <vector>

#include "player.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {

enum class Aim : std::uint8_t {
  error,   ///< the largest error while the vector is valid
  accuse,  ///< a healthy sensor suspected, provisionally excluded, excluded
  fail,    ///< failed
};

class Adversary {
 public:
  Adversary(Player& player, Aim aim, std::uint64_t stream);
  /// One block at the player's attitude, the faulty sensors as the adversary likes.
  void block();

 private:
  /// What is added to the readings of the faulty sensors, from a sample of the block on.
  struct Lie {
    plumb::Readings add_mps2{};
    int from = 0;
  };
  static constexpr int kCandidates = 12;

  Lie candidate(int number);
  Lie bias_of_one();
  Lie common_vector(const plumb::Vec3& difference_mps2) const;
  plumb::Vec3 mirror_image();
  double worth(const Lie& lie);
  double worth_of(const plumb::Verdict& v) const;
  plumb::Sample told(const plumb::Sample& honest, const Lie& lie, int k) const;

  Player& player_;
  Aim aim_;
  plumb_test::TrialNoise noise_;
  Lie last_;
  std::vector<plumb::Sample> honest_;
  std::unique_ptr<plumb::HealthMonitor> copy_ = std::make_unique<plumb::HealthMonitor>();
};

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
