#include "ceres_rivals.hpp"

#include <ceres/ceres.h>
#include <ceres/tiny_solver.h>
#include <ceres/tiny_solver_autodiff_function.h>

#include <array>
#include <deque>
#include <memory>

#include "plumb/paper/paper_calibration.hpp"

namespace plumb_bench {
inline namespace PLUMB_ABI {
namespace {

using plumb::Vec3;

constexpr int kSensors = 4;
constexpr int kForward = 16;  ///< sensor by sensor W, b

using Readings = std::array<double, kSensors>;

std::vector<Readings> readings_of(const Problem& p) {
  std::vector<Readings> out;
  const plumb::SensorModel model = p.sheet.model();
  for (const plumb::Station& s : p.stations) {
    const plumb::Readings y = model.apply(s.mean, s.temperature_degc, s.delivered);
    Readings r{};
    for (int i = 0; i < kSensors; ++i) r[at(i)] = y[at(i)];
    out.push_back(r);
  }
  return out;
}

std::array<double, kForward> datasheet_start(const Problem& p) {
  std::array<double, kForward> x{};
  for (int i = 0; i < kSensors; ++i) {
    for (int q = 0; q < 3; ++q) x[at(4 * i + q)] = p.sheet.sensor[at(i)].row.axis[at(q)];
  }
  return x;
}

/// (theta - datasheet) in units of the prior, linear.
class PriorCost final : public ceres::SizedCostFunction<kForward, kForward> {
 public:
  explicit PriorCost(const Problem& p) : start_(datasheet_start(p)) {
    for (int i = 0; i < kSensors; ++i) {
      const plumb::DatasheetSensor& s = p.sheet.sensor[at(i)];
      for (int q = 0; q < 3; ++q) {
        for (int r = 0; r < 3; ++r) {
          const double along = s.row.axis[at(q)] * s.row.axis[at(r)];
          root_[at((4 * i + q) * kForward + 4 * i + r)] =
              along / s.prior.scale + ((q == r ? 1.0 : 0.0) - along) / s.prior.axis_rad;
        }
      }
      root_[at((4 * i + 3) * kForward + 4 * i + 3)] = 1.0 / s.prior.bias_mps2;
    }
  }
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    for (int a = 0; a < kForward; ++a) {
      residuals[a] = 0.0;
      for (int b = 0; b < kForward; ++b) residuals[a] += root_[at(a * kForward + b)] * (x[0][b] - start_[at(b)]);
    }
    if (jacobians != nullptr && jacobians[0] != nullptr) std::copy(root_.begin(), root_.end(), jacobians[0]);
    return true;
  }

 private:
  std::array<double, kForward> start_;
  std::array<double, std::size_t{kForward} * kForward> root_{};
};

/// (y - G W u - b) / sigma.
class StationCost final : public ceres::SizedCostFunction<kSensors, kForward, 3> {
 public:
  explicit StationCost(const Readings& y) : y_(y) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const double* u = x[1];
    const double g = plumb::kG0_mps2 / kSigma_mps2;
    for (int i = 0; i < kSensors; ++i) {
      const double* w = x[0] + 4 * i;
      residuals[i] = (y_[at(i)] - w[3]) / kSigma_mps2 - g * (w[0] * u[0] + w[1] * u[1] + w[2] * u[2]);
    }
    if (jacobians == nullptr) return true;
    for (int i = 0; i < kSensors; ++i) {
      if (jacobians[0] != nullptr) {
        double* row = jacobians[0] + kForward * i;
        std::fill(row, row + kForward, 0.0);
        for (int q = 0; q < 3; ++q) row[4 * i + q] = -g * u[q];
        row[4 * i + 3] = -1.0 / kSigma_mps2;
      }
      if (jacobians[1] != nullptr) {
        for (int q = 0; q < 3; ++q) jacobians[1][3 * i + q] = -g * x[0][4 * i + q];
      }
    }
    return true;
  }

 private:
  Readings y_;
};

/// Norm and parity residual in standard deviations, the direction inside; derivatives at the fitted direction.
class EliminatedCost final : public ceres::SizedCostFunction<2, kForward> {
 public:
  explicit EliminatedCost(const Readings& y) : y_(y) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    Eigen::Matrix<double, kSensors, 3> w;
    Eigen::Vector4d y;
    for (int i = 0; i < kSensors; ++i) {
      for (int q = 0; q < 3; ++q) w(i, q) = x[0][4 * i + q];
      y(i) = y_[at(i)] - x[0][4 * i + 3];
    }
    const Eigen::Matrix3d spread = (w.transpose() * w).inverse();
    const Eigen::Vector3d estimate = spread * (w.transpose() * y);
    Eigen::Vector3d u = estimate.normalized();
    for (int step = 0; step < 3; ++step) {
      const Eigen::Vector3d a = spread * u, off = estimate / plumb::kG0_mps2 - u;
      u = (u + off - a * (u.dot(off) / u.dot(a))).normalized();
    }
    Eigen::Vector4d p;
    for (int i = 0; i < kSensors; ++i) {
      Eigen::Matrix3d minor;
      for (int k = 0, row = 0; k < kSensors; ++k) {
        if (k != i) minor.row(row++) = w.row(k);
      }
      p(i) = (i % 2 == 0 ? 1.0 : -1.0) * minor.determinant();
    }
    p.normalize();
    const Eigen::Vector3d a = spread * u;
    const double deviation = 1.0 / std::sqrt(u.dot(a));
    const Eigen::Vector4d normal = w * a * deviation;
    residuals[0] = (u.dot(estimate) - plumb::kG0_mps2) * deviation / kSigma_mps2;
    residuals[1] = p.dot(y) / kSigma_mps2;
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    for (int i = 0; i < kSensors; ++i) {
      for (int q = 0; q < 4; ++q) {
        const double z = (q < 3 ? plumb::kG0_mps2 * u(q) : 1.0) / kSigma_mps2;
        jacobians[0][4 * i + q] = -normal(i) * z;
        jacobians[0][kForward + 4 * i + q] = -p(i) * z;
      }
    }
    return true;
  }

 private:
  Readings y_;
};

/// |x|^2 - G^2 of one station, with its derivatives, by plumb's own function of the paper's error.
template <int n>
class PaperCost final : public ceres::SizedCostFunction<1, plumb::paper_parameters(n)> {
 public:
  PaperCost(const plumb::PaperError& error, const plumb::Station& station) : error_(error), station_(station) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    plumb::PaperParameters theta{}, gradient;
    std::copy(x[0], x[0] + plumb::paper_parameters(n), theta.begin());
    const bool wanted = jacobians != nullptr && jacobians[0] != nullptr;
    residuals[0] = error_(theta, station_, wanted ? &gradient : nullptr);
    if (wanted) std::copy(gradient.begin(), gradient.begin() + plumb::paper_parameters(n), jacobians[0]);
    return true;
  }

 private:
  const plumb::PaperError& error_;
  const plumb::Station& station_;
};

/// All stations of the paper's cost for automatic derivatives, parameters in prior units.
template <int n>
struct PaperFunctor {
  static constexpr int kSize = plumb::paper_parameters(n);
  const Problem& problem;
  const plumb::PaperError& error;
  Eigen::Matrix<double, 3, n> map;  ///< least-squares map of the nominal axes

  int NumResiduals() const { return static_cast<int>(problem.stations.size()); }

  template <typename T>
  bool operator()(const T* x, T* residuals) const {
    std::array<T, std::size_t{kSize}> theta;
    for (int k = 0; k < kSize; ++k) theta[at(k)] = error.start()[at(k)] + error.prior()[at(k)] * x[k];
    for (std::size_t s = 0; s < problem.stations.size(); ++s) {
      std::array<T, std::size_t{n}> direct, a;
      for (int i = 0; i < n; ++i) {
        direct[at(i)] = problem.stations[s].mean[at(i)] / theta[at(n + i)] - theta[at(i)];
      }
      int m = 2 * n;
      for (int i = 0; i < n; ++i) {
        a[at(i)] = direct[at(i)];
        for (int j = 0; j < n; ++j) {
          if (j != i) a[at(i)] -= theta[at(m++)] * direct[at(j)];
        }
      }
      T square(-plumb::kG0_mps2 * plumb::kG0_mps2);
      for (int q = 0; q < 3; ++q) {
        T component = map(q, 0) * a[0];
        for (int i = 1; i < n; ++i) component += map(q, i) * a[at(i)];
        square += component * component;
      }
      residuals[s] = square;
    }
    return true;
  }
};

template <int n>
Eigen::Matrix<double, 3, n> nominal_map(const Problem& problem) {
  Eigen::Matrix<double, n, 3> h;
  for (int i = 0; i < n; ++i) {
    for (int q = 0; q < 3; ++q) h(i, q) = problem.sheet.sensor[at(i)].row.axis[at(q)];
  }
  return (h.transpose() * h).inverse() * h.transpose();
}

ceres::Solver::Options quiet() {
  ceres::Solver::Options o;
  o.max_num_iterations = 100;
  o.logging_type = ceres::SILENT;
  o.num_threads = 1;
  return o;
}

ceres::Problem::Options borrowed() {
  ceres::Problem::Options o;
  o.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  o.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  return o;
}

template <int n>
double paper_by_ceres(const Problem& problem) {
  const auto error = plumb::PaperError::make(problem.sheet, gravity(), plumb::SensorSet::first(n));
  if (!error) return -1.0;
  std::deque<PaperCost<n>> costs;
  plumb::PaperParameters theta = error->start();
  ceres::Problem p(borrowed());
  for (const plumb::Station& s : problem.stations) {
    costs.emplace_back(*error, s);
    p.AddResidualBlock(&costs.back(), nullptr, theta.data());
  }
  ceres::Solver::Options options = quiet();
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &p, &summary);
  return 2.0 * summary.final_cost / static_cast<double>(problem.stations.size());
}

template <int n>
double paper_by_tiny(const Problem& problem) {
  const auto error = plumb::PaperError::make(problem.sheet, gravity(), plumb::SensorSet::first(n));
  if (!error) return -1.0;
  const PaperFunctor<n> functor{problem, *error, nominal_map<n>(problem)};
  using Function = ceres::TinySolverAutoDiffFunction<PaperFunctor<n>, Eigen::Dynamic, PaperFunctor<n>::kSize>;
  const Function function(functor);
  ceres::TinySolver<Function> solver;
  Eigen::Matrix<double, PaperFunctor<n>::kSize, 1> x;
  x.setZero();
  const auto summary = solver.Solve(function, &x);
  return 2.0 * summary.final_cost / static_cast<double>(problem.stations.size());
}

}  // namespace

double ceres_forward(const Problem& problem) {
  const std::vector<Readings> y = readings_of(problem);
  PriorCost prior(problem);
  std::deque<StationCost> costs;
  std::array<double, kForward> theta = datasheet_start(problem);
  std::vector<std::array<double, 3>> u(y.size());
  ceres::SphereManifold<3> sphere;
  ceres::Problem p(borrowed());
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  const Eigen::Matrix<double, 3, kSensors> map = nominal_map<kSensors>(problem);
  p.AddResidualBlock(&prior, nullptr, theta.data());
  for (std::size_t s = 0; s < y.size(); ++s) {
    const Eigen::Vector3d start = (map * Eigen::Map<const Eigen::Vector4d>(y[s].data())).normalized();
    for (int q = 0; q < 3; ++q) u[s][at(q)] = start(q);
    costs.emplace_back(y[s]);
    p.AddResidualBlock(&costs.back(), nullptr, theta.data(), u[s].data());
    p.SetManifold(u[s].data(), &sphere);
    ordering->AddElementToGroup(u[s].data(), 0);
  }
  ordering->AddElementToGroup(theta.data(), 1);
  ceres::Solver::Options options = quiet();
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.linear_solver_ordering = ordering;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &p, &summary);
  return 2.0 * summary.final_cost;
}

double ceres_eliminated(const Problem& problem) {
  const std::vector<Readings> y = readings_of(problem);
  PriorCost prior(problem);
  std::deque<EliminatedCost> costs;
  std::array<double, kForward> theta = datasheet_start(problem);
  ceres::Problem p(borrowed());
  p.AddResidualBlock(&prior, nullptr, theta.data());
  for (const Readings& r : y) {
    costs.emplace_back(r);
    p.AddResidualBlock(&costs.back(), nullptr, theta.data());
  }
  ceres::Solver::Options options = quiet();
  options.linear_solver_type = ceres::DENSE_NORMAL_CHOLESKY;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &p, &summary);
  return 2.0 * summary.final_cost;
}

double ceres_paper(const Problem& problem) { return paper_by_ceres<4>(problem); }
double ceres_paper_triple(const Problem& problem) { return paper_by_ceres<3>(problem); }
double tiny_paper(const Problem& problem) { return paper_by_tiny<4>(problem); }
double tiny_paper_triple(const Problem& problem) { return paper_by_tiny<3>(problem); }

}  // namespace PLUMB_ABI
}  // namespace plumb_bench
