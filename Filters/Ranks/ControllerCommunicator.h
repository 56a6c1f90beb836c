#ifndef ControllerCommunicator_h
#define ControllerCommunicator_h

#include "Distribution/Communicator.h"
#include "Ranks/RankMeeting.h"

#include "vtkMPICommunicator.h"

#include <list>
#include <vector>

class vtkMPIController;

namespace tyndall
{
/// What the ranks of a parallel pipeline say to each other, by VTK's controller of MPI.
class ControllerCommunicator : public Communicator
{
public:
  /// @param controller  must stay
  /// @param patience  seconds that a rank waits for another that says nothing before it gives up: none hangs
  explicit ControllerCommunicator(vtkMPIController* controller, double patience = SecondsToWait());
  /// Waits until what was sent is on its way.
  ~ControllerCommunicator() override;

  int Rank() const override;
  int Ranks() const override;

protected:
  void Give(int to, int tag, std::vector<char> bytes) override;
  std::vector<char> Take(int from, int tag) override;

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
  std::list<Underway> Sending;
};
}

#endif
