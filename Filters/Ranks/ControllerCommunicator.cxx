#include "Ranks/ControllerCommunicator.h"

#include "vtkMPIController.h"

#include <chrono>
#include <limits>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>

namespace tyndall
{
namespace
{
constexpr int FirstTag = 1000; ///< behind those that VTK uses itself

/// What an MPI call says that did not do what it should.
void RequireSent(bool done, const char* what, int rank)
{
  if (!done)
  {
    throw std::runtime_error(std::string(what) + " rank " + std::to_string(rank) + " failed: is it still there?");
  }
}
}

ControllerCommunicator::ControllerCommunicator(vtkMPIController* controller, double patience)
  : Controller(controller)
  , Patience(patience)
{
}

ControllerCommunicator::~ControllerCommunicator()
{
  for (Underway& message : this->Sending)
  {
    message.request.Wait();
  }
}

int ControllerCommunicator::Rank() const
{
  return this->Controller->GetLocalProcessId();
}

int ControllerCommunicator::Ranks() const
{
  return this->Controller->GetNumberOfProcesses();
}

/// A send that waits for its receiver could wait for one that waits for this rank to receive: rays of different octants
/// go both ways between two blocks.
void ControllerCommunicator::Give(int to, int tag, std::vector<char> bytes)
{
  this->ForgetSent();
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
  {
    throw std::runtime_error("A message of " + std::to_string(bytes.size()) +
      " bytes is longer than MPI takes: spread the medium over more ranks.");
  }
  this->Sending.push_back({ std::move(bytes), {} });
  Underway& message = this->Sending.back();
  const int length = static_cast<int>(message.bytes.size());
  RequireSent(this->Controller->NoBlockSend(message.bytes.data(), length, to, FirstTag + tag, message.request) == 1,
    "Sending to", to);
}

void ControllerCommunicator::ForgetSent()
{
  for (auto message = this->Sending.begin(); message != this->Sending.end();)
  {
    message = message->request.Test() ? this->Sending.erase(message) : std::next(message);
  }
}

std::vector<char> ControllerCommunicator::Take(int from, int tag)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  for (;;)
  {
    int isThere = 0, source = 0, length = 0;
    const char* type = nullptr;
    RequireSent(this->Controller->Iprobe(from, FirstTag + tag, &isThere, &source, type, &length) == 1,
      "Asking for a message of", from);
    if (isThere)
    {
      std::vector<char> bytes(static_cast<std::size_t>(length) + 1); // there is no array of nothing
      RequireSent(this->Controller->Receive(bytes.data(), length, from, FirstTag + tag) == 1, "Receiving from", from);
      bytes.resize(static_cast<std::size_t>(length));
      return bytes;
    }
    const std::chrono::duration<double> waited = Clock::now() - start;
    if (waited.count() > this->Patience)
    {
      throw std::runtime_error("Nothing came from rank " + std::to_string(from) + " within " +
        std::to_string(static_cast<int>(this->Patience)) + " s: it may be gone.");
    }
    this->ForgetSent();
    std::this_thread::sleep_for(std::chrono::microseconds(waited.count() < 1e-3 ? 0 : 50));
  }
}
}
