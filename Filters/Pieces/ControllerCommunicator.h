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
/// Timeout for waiting on another rank, seconds: the current value of the environment variable TYNDALL_RANKS_WAIT,
/// default 600. A filter upstream may therefore take up to this time longer on one rank than on another.
double SecondsToWait();

/// Starts a new range of message tags, so that messages left over from earlier work are not received. Called on all
/// ranks at the start of WorkOnAllRanks.
void BeginConversations();

/// Makes a communicator for the ranks that run a filter together. Collective: if a filter makes several communicators,
/// all ranks make them in the same order.
/// @param ranks    must outlive the communicator; null: this process is alone
/// @param stopped  returns whether to stop waiting for other ranks; a pending receive then throws Aborted one second
///   later
/// @param patience  timeout for waiting on another rank, seconds
std::unique_ptr<Communicator> CommunicatorOf(
  vtkMultiProcessController* ranks, std::function<bool()> stopped = {}, double patience = SecondsToWait());

/// Makes a communicator, as CommunicatorOf does, for the ranks that render a frame together, outside WorkOnAllRanks. It
/// uses a separate range of tags.
std::unique_ptr<Communicator> CommunicatorOfFrame(vtkMultiProcessController* ranks);

/// Makes the communicator for the end of WorkOnAllRanks. Its tags do not depend on how many communicators a rank made
/// before an error.
std::unique_ptr<Communicator> CommunicatorAtEnd(vtkMultiProcessController* ranks);

#ifdef TYNDALL_HAS_MPI
/// Communicator that uses VTK's MPI controller, and DIY for exchanges if the host application has it.
class ControllerCommunicator : public Communicator
{
public:
  /// Makes a communicator for all ranks of a controller.
  /// @param controller    must outlive the communicator
  /// @param patience      timeout of a receive, seconds
  /// @param conversation  number >= 0, the same on all ranks, that selects the range of message tags
  explicit ControllerCommunicator(vtkMPIController* controller, double patience = SecondsToWait(),
    std::function<bool()> stopped = {}, int conversation = 0);
  /// Waits until pending sends are complete, unless an error is being thrown.
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
  /// A message whose nonblocking send is not complete, and its MPI request.
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
/// Sends one parcel (array of bytes) to each rank of `with` and receives one from each, by DIY with one block per rank.
/// Collective. Parcels may have any length: DIY splits messages into parts of 2 GiB.
///
/// DIY has no timeout, so ranks agree beforehand that none has failed (Communicator::Exchange). If a rank times out, or
/// lacks memory for what it receives, it ends its process. MPI then ends all ranks, so that no rank waits forever.
/// @param with      ranks to exchange with, other than this one
/// @param parcels   one for each rank of `with`
/// @param patience  timeout, seconds
/// @return the received parcels, in the order of `with`
std::vector<std::vector<char>> ExchangeByDIY(
  vtkMPIController* controller, const std::vector<int>& with, std::vector<std::vector<char>> parcels, double patience);
#endif
}

#endif
