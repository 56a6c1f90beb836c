#include "DiscreteOrdinates/OrdinatesScene.h"

namespace tyndall
{
void OrdinatesRecord::Add(double goesOn, double more, const EnergyLedger& ledger)
{
  const EnergyBalance& balance = ledger.Balance();
  this->Sum += more;
  this->Left = goesOn > 0.0 ? this->Rest.After(goesOn, this->Sum) : 0.0;
  this->Rows.push_back({ static_cast<int>(this->Rows.size()), ClockSeconds() - this->Start, this->Left,
    this->Sum > 0.0 ? goesOn / this->Sum : 0.0, balance.absorbed[0], balance.escaped[0], balance.leftOver[0] });
}
}
