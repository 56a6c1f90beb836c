#include "Photons/Distributed/TurnsInBlocks.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace tyndall
{
/// Moves photons that have reached the end of the turn inside the block from `photons` to those that wait.
void WaitingPhotons::KeepThoseThatWait(const TurnSchedule& turn, std::vector<PhotonOnItsWay>& photons)
{
  const auto waiting = std::partition(photons.begin(), photons.end(), [&](const PhotonOnItsWay& photon) {
    return turn.last || photon.crossings < turn.gone || !Holds(this->Own, WhereIs(photon));
  });
  this->Waiting.insert(this->Waiting.end(), waiting, photons.end());
  photons.erase(waiting, photons.end());
}

std::vector<PhotonOnItsWay> WaitingPhotons::Follow(
  const TurnSchedule& turn, int round, std::vector<PhotonOnItsWay>&& arrived, const Monitor& monitor)
{
  if (!this->March)
  {
    return {};
  }
  std::vector<PhotonOnItsWay> going = round == 0 ? std::exchange(this->Waiting, {}) : std::move(arrived);
  this->KeepThoseThatWait(turn, going); // photons that entered this block with the last segment of the turn
  this->March->GoAsFarAs(turn);
  MarchRun::Outcome outcome = std::exchange(this->Started, true)
    ? this->March->Resume(std::move(going), monitor)
    : this->March->Start(this->Starting.packed, this->Starting.marks, monitor);
  this->TellEnds(outcome.ends);
  this->KeepThoseThatWait(turn, outcome.gone);
  return std::move(outcome.gone);
}

void WaitingPhotons::ToTheirEnds(
  const TurnsInBlocks& turns, int limit, const std::function<const Buffer<float>&()>& show, const Monitor& monitor)
{
  constexpr double part = 0.1; // of the remaining work, as far as known
  const std::size_t all = PlaceAmong(this->Comm, this->Starting.packed.Count()).all;
  TurnSchedule turn(turns.stretches, limit, all);
  double done = 0.0;
  bool first = true;
  for (std::size_t left = all; left > 0; first = false)
  {
    turn.Next(left);
    const double next = done + part * (1.0 - done);
    this->TheRounds.UntilAllEnd<PhotonOnItsWay>(
      [&](int round, std::vector<PhotonOnItsWay>&& arrived, const Monitor& ofRound) {
        return this->Follow(turn, round, std::move(arrived), ofRound);
      },
      OfPart(monitor, done, next));
    if (!first)
    {
      turns.meanwhile();
    }
    const Buffer<float>* fluence = nullptr;
    this->Comm.Collective([&] { fluence = &show(); });
    turns.take(*fluence);
    left = PlaceAmong(this->Comm, this->Waiting.size()).all;
    done = std::max(next, 1.0 - static_cast<double>(left) / static_cast<double>(all));
  }
}
}
