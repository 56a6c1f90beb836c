#pragma once

#include "Light/LightField.h"
#include "LightPropagation/Conservative/EnergyLedger.h"

#include <chrono>
#include <vector>

namespace tyndall
{
/// The rows of the `convergence` table, with the time since construction.
class ConvergenceRecord
{
public:
  void Add(double residual, double change, const EnergyLedger& ledger)
  {
    const EnergyBalance& balance = ledger.Balance();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - this->Start;
    this->Rows.push_back({ static_cast<int>(this->Rows.size()), seconds.count(), residual, change,
      Sum(balance.absorbed), Sum(balance.escaped), Sum(balance.leftOver) });
  }
  const std::vector<ConvergenceRow>& All() const { return this->Rows; }

private:
  std::chrono::steady_clock::time_point Start = std::chrono::steady_clock::now();
  std::vector<ConvergenceRow> Rows;
};
}
