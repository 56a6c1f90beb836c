#ifndef ControllerCommunicator_h
#define ControllerCommunicator_h

#include "Distribution/Communicator.h"

#include <functional>
#include <memory>

#ifdef TYNDALL_HAS_MPI
#include "vtkMPICommunicator.h"

#include <list>
#include <vector>

class vtkMPIController;
#endif

class vtkMultiProcessController;

namespace tyndall
{
/// Seconds that a rank waits for another before it gives up: 600, or what the variable TYNDALL_RANKS_WAIT says now. A
/// filter upstream may take that much longer on one rank than on another.
double SecondsToWait();

/// At the start of WorkOnAllRanks: communicators get new tags, so that messages left from earlier work are not
/// received.
void BeginConversations();

/// Message passing among the ranks that work together. Collective: all ranks make the same ones, in the same order.
/// @param ranks  must outlive it; null: this process is alone
/// @param stopped  whether a rank that waits for another is to give up (Aborted), a second later
std::unique_ptr<Communicator> CommunicatorOf(vtkMultiProcessController* ranks, std::function<bool()> stopped = {});

/// The same for ranks that draw a frame together, outside WorkOnAllRanks: with tags of its own.
std::unique_ptr<Communicator> CommunicatorOfFrame(vtkMultiProcessController* ranks);

/// The last one of WorkOnAllRanks, however many a rank made before an error.
std::unique_ptr<Communicator> CommunicatorAtEnd(vtkMultiProcessController* ranks);

#ifdef TYNDALL_HAS_MPI
/// By VTK's MPI controller; exchanges by DIY if the host has it.
class ControllerCommunicator : public Communicator
{
public:
  /// @param controller  must outlive it
  /// @param patience  timeout of a receive, seconds
  /// @param conversation  the same on all ranks, from 0 on; selects the tags
  explicit ControllerCommunicator(vtkMPIController* controller, double patience = SecondsToWait(),
    std::function<bool()> stopped = {}, int conversation = 0);
  /// Completes pending sends, unless an error is being thrown.
  ~ControllerCommunicator() override;

  int Rank() const override;
  int Ranks() const override;

protected:
  void Give(int to, int tag, std::vector<char> bytes) override;
  std::vector<char> Take(int from, int tag) override;
#ifdef TYNDALL_HAS_DIY
  std::vector<std::vector<char>> Swap(const std::vector<int>& with, std::vector<std::vector<char>> parcels) override;
#endif

private:
  /// A message that is still being sent.
  struct Underway
  {
    std::vector<char> bytes;
    vtkMPICommunicator::Request request;
  };
  void ForgetSent();

  vtkMPIController* Controller;
  double Patience;
  std::function<bool()> Stopped;
  int FirstTag;
  std::list<Underway> Sending;
};
#endif

#ifdef TYNDALL_HAS_DIY
/// One parcel to each of some ranks and one from each of them, by DIY with one block a rank. Collective. Of any length:
/// DIY cuts messages into parts of 2 GiB.
///
/// DIY has no timeout, so ranks agree beforehand that none fails (Communicator::Exchange). A rank that times out, or
/// lacks memory for what it receives, ends its process, and MPI those of all ranks: none hangs.
/// @param with  ranks that exchange with this one, which is not among them
/// @param parcels  one for each of them
/// @param patience  timeout, seconds
/// @return by the ranks of `with`
std::vector<std::vector<char>> ExchangeByDIY(
  vtkMPIController* controller, const std::vector<int>& with, std::vector<std::vector<char>> parcels, double patience);
#endif
}

#endif
