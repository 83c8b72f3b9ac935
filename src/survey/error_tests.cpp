#include "plumb/survey/error_tests.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "plumb/numeric/tails.hpp"
#include "totals_residual.hpp"

namespace plumb {
inline namespace PLUMB_ABI {
namespace survey {
namespace {

/// What is left of a difference of numbers that are alike: of an absurd station, whose shared error is 1e8 times its
/// random one, the inverse's diagonal may round to 0, and is above it.
constexpr double kRounding = 1e-15;
constexpr int kShared = static_cast<int>(kTermCount) + 1;

/// Residuals of one kind: C = diag(random) + shared shared'.
struct Channel {
  Eigen::VectorXd residual, random;
  Eigen::MatrixXd shared;  ///< a column a term of the tool, one of the reference, each times its sigma
};

/// By Woodbury's identity, so that thousands of stations take no matrix of their square.
struct Inverse {
  Eigen::VectorXd inverse_random;
  Eigen::MatrixXd scaled;  ///< D^-1 V L^-T, L L' = 1 + V' D^-1 V
  explicit Inverse(const Channel& c) : inverse_random(c.random.cwiseInverse()) {
    const Eigen::MatrixXd weighted = inverse_random.asDiagonal() * c.shared;
    const Eigen::MatrixXd inner =
        Eigen::MatrixXd::Identity(c.shared.cols(), c.shared.cols()) + c.shared.transpose() * weighted;
    const Eigen::LLT<Eigen::MatrixXd> factor(inner);
    scaled = factor.matrixL().solve(weighted.transpose()).transpose();
  }
  Eigen::VectorXd times(const Eigen::VectorXd& v) const {
    return inverse_random.cwiseProduct(v) - scaled * (scaled.transpose() * v);
  }
  Eigen::VectorXd diagonal() const {
    return (inverse_random - scaled.rowwise().squaredNorm()).cwiseMax(kRounding * inverse_random);
  }
};

ErrorTest test_of(const Channel& channel, double false_alarm) {
  const Eigen::Index n = channel.residual.size();
  const Inverse inverse(channel);
  const Eigen::VectorXd weighted = inverse.times(channel.residual);
  const Eigen::VectorXd normalised = weighted.cwiseQuotient(inverse.diagonal().cwiseSqrt());
  const double of_ones =
      std::max(inverse.times(Eigen::VectorXd::Ones(n)).sum(), kRounding * inverse.inverse_random.sum());
  ErrorTest out;
  out.residual.assign(channel.residual.data(), channel.residual.data() + n);
  out.normalised.assign(normalised.data(), normalised.data() + n);
  Eigen::Index worst = 0;
  normalised.cwiseAbs().maxCoeff(&worst);
  out.worst = static_cast<int>(worst);
  out.one_limit = normal_tail_quantile(std::max(1e-15, 0.5 * false_alarm / static_cast<double>(n)));
  out.chi_square = channel.residual.dot(weighted);
  out.chi_square_limit =
      boost::math::quantile(boost::math::complement(boost::math::chi_squared(static_cast<double>(n)), false_alarm));
  out.mean = weighted.sum() / of_ones;
  out.mean_sigma = 1.0 / std::sqrt(of_ones);
  out.mean_limit = normal_tail_quantile(0.5 * false_alarm) * out.mean_sigma;
  return out;
}

tl::unexpected<io::FileError> refuse(const std::string& field, const char* what, const char* remedy) {
  return tl::unexpected<io::FileError>(io::FileError{"", 0, field, what, remedy, io::ExitCode::invalid_input});
}

}  // namespace

bool ErrorTest::one_passed() const noexcept {
  return !normalised.empty() && std::fabs(normalised[static_cast<std::size_t>(worst)]) <= one_limit;
}

bool ErrorTest::mean_passed() const noexcept { return std::fabs(mean) <= mean_limit; }

io::FileExpected<ErrorTests> error_tests(const std::vector<ReferencedStation>& stations,
                                         const ErrorTestSettings& settings) {
  if (stations.empty()) return refuse("stations", "there are none", "give one at least");
  const auto n = static_cast<Eigen::Index>(stations.size());
  std::array<Channel, 3> channels;
  for (Channel& c : channels) {
    c.residual.resize(n);
    c.random.resize(n);
    c.shared.resize(n, kShared);
  }
  Eigen::Matrix<double, static_cast<int>(kTermCount), 1> sigma;
  for (std::size_t k = 0; k < kTermCount; ++k)
    sigma[static_cast<Eigen::Index>(k)] = sigma_of(static_cast<Term>(k), settings.tool);
  for (Eigen::Index i = 0; i < n; ++i) {
    const ReferencedStation& at = stations[static_cast<std::size_t>(i)];
    const std::string name = fmt::format("station at {:.2f} m", at.measured.md_m);
    const Eigen::Vector3d r = totals_residual(at.measured, at.reference), random = random_covariance(at).diagonal();
    if (!r.allFinite() || !random.allFinite()) return refuse(name, "holds a number that is not finite", "leave it out");
    if (!(random.minCoeff() > 0.0)) return refuse(name, "states no random error", "state the noise of its means");
    const std::array<double, 72> weights = term_weights(at.measured);
    const TermMatrix shared =
        totals_derivatives(at.measured) * matrix_of<6, static_cast<int>(kTermCount)>(weights) * sigma.asDiagonal();
    const Eigen::Vector3d common = common_sigma(at.reference);
    for (int kind = 0; kind < 3; ++kind) {
      Channel& c = channels[static_cast<std::size_t>(kind)];
      c.residual[i] = r[kind];
      c.random[i] = random[kind];
      c.shared.row(i) << shared.row(kind), common[kind];
    }
  }
  const double false_alarm = std::clamp(settings.false_alarm, 1e-12, 0.5);
  return ErrorTests{test_of(channels[0], false_alarm), test_of(channels[1], false_alarm),
                    test_of(channels[2], false_alarm)};
}

}  // namespace survey
}  // namespace PLUMB_ABI
}  // namespace plumb
