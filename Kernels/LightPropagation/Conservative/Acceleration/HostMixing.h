#pragma once

#include <Eigen/Dense>

#include <algorithm>
#include <vector>

namespace tyndall
{
/// Anderson mixing (numerics.md, Eq. (71)) of short vectors on the host; used for reflected light. The next iterate is
/// the combination of the last results whose change is smallest in the least-squares sense, with negative entries set
/// to 0.
class HostMixing
{
public:
  /// @param given  the iterate
  /// @param found  result of one iteration from `given`
  /// @return the next iterate
  std::vector<double> Next(const std::vector<double>& given, const std::vector<double>& found)
  {
    const auto size = static_cast<Eigen::Index>(found.size());
    const Eigen::VectorXd result = Eigen::Map<const Eigen::VectorXd>(found.data(), size);
    const Eigen::VectorXd change = result - Eigen::Map<const Eigen::VectorXd>(given.data(), size);
    Eigen::VectorXd next = result;
    const auto count = static_cast<Eigen::Index>(this->Results.size());
    if (count > 0)
    {
      Eigen::MatrixXd changes(size, count);
      for (Eigen::Index k = 0; k < count; ++k)
      {
        changes.col(k) = change - this->Changes[k];
      }
      Eigen::ColPivHouseholderQR<Eigen::MatrixXd> squares(changes);
      squares.setThreshold(1e-6);
      const Eigen::VectorXd weights = squares.solve(change);
      for (Eigen::Index k = 0; k < count; ++k)
      {
        next -= weights[k] * (result - this->Results[k]);
      }
    }
    this->Keep(result, change);
    std::vector<double> values(next.data(), next.data() + size);
    std::for_each(values.begin(), values.end(), [](double& value) { value = std::max(value, 0.0); });
    return values;
  }

private:
  static constexpr std::size_t Depth = 3;

  void Keep(const Eigen::VectorXd& result, const Eigen::VectorXd& change)
  {
    if (this->Results.size() == Depth)
    {
      this->Results.erase(this->Results.begin());
      this->Changes.erase(this->Changes.begin());
    }
    this->Results.push_back(result);
    this->Changes.push_back(change);
  }

  std::vector<Eigen::VectorXd> Results, Changes;
};
}
