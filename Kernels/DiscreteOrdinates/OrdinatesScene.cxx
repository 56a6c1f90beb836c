#include "DiscreteOrdinates/OrdinatesScene.h"

#include <algorithm>

namespace tyndall
{
void OrdinatesRecord::Add(double scattered, const EnergyLedger& ledger)
{
  const EnergyBalance& balance = ledger.Balance();
  this->Sum += scattered;
  const bool first = this->Rows.empty();
  const double ratio = first ? 1.0 : this->Last > 0.0 ? scattered / this->Last : 0.0;
  const double growth = this->Rows.size() > 1 ? std::max(0.0, ratio - this->Ratio) : 0.0;
  const double limit = std::min(ratio + growth, 1.0 - 1e-9);
  const double part = this->Sum > 0.0 ? scattered / this->Sum : 0.0;
  this->Left = first ? std::min(part, 1.0) : part * limit / (1.0 - limit);
  this->Ratio = ratio;
  this->Last = scattered;
  this->Rows.push_back({ static_cast<int>(this->Rows.size()), ClockSeconds() - this->Start, this->Left, part,
    balance.absorbed[0], balance.escaped[0], balance.leftOver[0] });
}
}
