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

/// Ranks begin to work together (WorkOnAllRanks): what communicators of earlier work left behind is not taken for
/// theirs.
void BeginConversations();

/// What the ranks that work together say to each other. All of them make the same ones, one after the other.
/// @param ranks  must stay; null: this process is alone
/// @param stopped  whether a rank that waits for another is to give up (Aborted), a second later
std::unique_ptr<Communicator> CommunicatorOf(vtkMultiProcessController* ranks, std::function<bool()> stopped = {});

/// Of ranks that draw a frame together, outside of any work: with tags of its own, so that nothing that work left
/// behind is taken for its messages.
std::unique_ptr<Communicator> CommunicatorOfFrame(vtkMultiProcessController* ranks);

/// The last one of the work, however many a rank made before something went wrong.
std::unique_ptr<Communicator> CommunicatorAtEnd(vtkMultiProcessController* ranks);

#ifdef TYNDALL_HAS_MPI
/// By VTK's controller of MPI; exchanges by DIY, where the host has it.
class ControllerCommunicator : public Communicator
{
public:
  /// @param controller  must stay
  /// @param patience  seconds that a rank waits for another that says nothing before it gives up: none hangs
  /// @param conversation  the same on all ranks, from 0 on; messages of another are not received
  explicit ControllerCommunicator(vtkMPIController* controller, double patience = SecondsToWait(),
    std::function<bool()> stopped = {}, int conversation = 0);
  /// Waits until what was sent is on its way, but where an error ends all: then for nobody.
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
  /// A message that is still being sent: its memory must stay.
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
/// What each rank has for some others, and what they have for it, all at once: an exchange of DIY's, of one block a
/// rank. All ranks call it. Of any length: DIY cuts messages into parts of 2 GiB.
///
/// DIY waits for others as long as it takes. So ranks agree before that none of them fails (Communicator::Exchange).
/// One that has not heard of others within the time, or cannot hold what comes, ends its process, and MPI those of
/// all: none hangs.
/// @param with  ranks that have something for each other, if only nothing; not this one
/// @param parcels  one for each of them
/// @param patience  seconds
/// @return by the ranks of `with`
std::vector<std::vector<char>> ExchangeByDIY(
  vtkMPIController* controller, const std::vector<int>& with, std::vector<std::vector<char>> parcels, double patience);
#endif
}

#endif
