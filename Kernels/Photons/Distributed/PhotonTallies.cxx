#include "Photons/Distributed/PhotonTallies.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

namespace tyndall
{
namespace
{
/// Powers and numbers of this rank to the sums of all.
void SumUp(Communicator& communicator, const std::vector<Rgb*>& powers, const std::vector<double*>& numbers)
{
  std::vector<double> values;
  for (const Rgb* power : powers)
  {
    values.insert(values.end(), power->begin(), power->end());
  }
  std::transform(
    numbers.begin(), numbers.end(), std::back_inserter(values), [](const double* number) { return *number; });
  values = communicator.Sum(values);
  auto value = values.cbegin();
  for (Rgb* power : powers)
  {
    std::copy_n(value, 3, power->begin());
    value += 3;
  }
  for (double* number : numbers)
  {
    *number = *value++;
  }
}
}

void AddUpTallies(Communicator& communicator, PhotonLight& result)
{
  EnergyBalance& balance = result.light.balance;
  std::vector<Rgb*> powers = { &balance.absorbed, &balance.escaped, &balance.leftOver, &result.scattered };
  for (Rgb& face : result.light.facePowerOut)
  {
    powers.push_back(&face);
  }
  double deposits = static_cast<double>(result.deposits), steps = static_cast<double>(result.steps);
  SumUp(communicator, powers, { &deposits, &steps });
  result.deposits = static_cast<std::size_t>(deposits);
  result.steps = static_cast<std::size_t>(steps);
}

void AddUpScattered(Communicator& communicator, PhotonLight& result)
{
  EnergyBalance& balance = result.light.balance;
  std::vector<Rgb*> powers = { &balance.entered, &balance.absorbed, &balance.escaped, &balance.leftOver,
    &result.exchanged };
  for (Rgb& face : result.light.facePowerOut)
  {
    powers.push_back(&face);
  }
  double scatterings = static_cast<double>(result.scatterings);
  SumUp(communicator, powers, { &scatterings });
  result.scatterings = static_cast<std::uint64_t>(scatterings);
}
}
