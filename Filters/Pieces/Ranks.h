#pragma once

#include "vtkMultiProcessController.h"
#include "vtkMultiProcessStream.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

class vtkAlgorithm;
class vtkInformation;
class vtkInformationVector;

/// The ranks of MPI that run a filter together, each for its piece of the output.
///
/// They do where ParaView spreads data (pvbatch --symmetric, pvserver), and in programs of VTK's whose ranks each ask
/// for one of as many pieces as there are ranks. Then all that they agree on is agreed by operations of VTK's global
/// controller that each of them reaches, whether its own part of the work failed or not. Where fewer pieces are asked
/// for, as by a rank that looks at the whole alone, nothing is agreed on, and nobody waits.
namespace tyndall
{
/// In RequestUpdateExtent: tells the filters before a port whether all ranks ask them, though each for the whole.
void AskTogether(vtkInformation* request, vtkInformationVector* outputs, vtkInformationVector* inputs);

/// In RequestData.
/// @return of the ranks that run the filter together; null: this process runs it alone
vtkMultiProcessController* RanksTogether(vtkInformation* request, vtkInformationVector* outputs);

/// In RequestUpdateExtent or RequestData: whether each rank asks for a piece of its own, as many as there are ranks.
bool EachAsksForItsPiece(vtkInformation* request, vtkInformationVector* outputs);

/// Does something on each rank. All of them have to call it.
/// @param controller  null: there is one rank
/// @throws what it threw, on every rank, where it threw on any of them: InvalidInput with the same words; where those
///   are not of all ranks, they say of which. An abort (Aborted) and a filter before that failed (InputFailed) are no
///   errors of their own
void OnAllRanks(vtkMultiProcessController* controller, const std::function<void()>& act);

/// The same of long work that can be stopped: where it ends early on one rank, the Monitor of the filter (MonitorOf)
/// stops it on the others. A part of it may be such work itself.
void WorkOnAllRanks(vtkMultiProcessController* controller, vtkAlgorithm* filter, const std::function<void()>& work);

/// Writes the members of a struct to a stream, or reads them: one function names them for both.
class StreamedMembers
{
public:
  StreamedMembers(vtkMultiProcessStream& stream, bool reads)
    : Stream(stream)
    , Reads(reads)
  {
  }

  void operator()(int& value) { this->Pass(value); }
  void operator()(double& value) { this->Pass(value); }
  void operator()(std::string& value) { this->Pass(value); }
  void operator()(bool& value)
  {
    int number = value;
    this->Pass(number);
    value = number != 0;
  }
  void operator()(std::uint64_t& value)
  {
    int high = static_cast<int>(value >> 32), low = static_cast<int>(value & 0xFFFFFFFFu);
    this->Pass(high);
    this->Pass(low);
    value = static_cast<std::uint64_t>(static_cast<std::uint32_t>(high)) << 32 | static_cast<std::uint32_t>(low);
  }
  template <class Value, std::size_t Size>
  void operator()(std::array<Value, Size>& values)
  {
    for (Value& value : values)
    {
      (*this)(value);
    }
  }
  template <class Value>
  void operator()(std::vector<Value>& values)
  {
    int size = static_cast<int>(values.size());
    this->Pass(size);
    values.resize(static_cast<std::size_t>(size));
    for (Value& value : values)
    {
      (*this)(value);
    }
  }
  /// Any other struct has a member function Stream(StreamedMembers&).
  template <class Struct>
  void operator()(Struct& value)
  {
    value.Stream(*this);
  }

private:
  template <class Value>
  void Pass(Value& value)
  {
    if (this->Reads)
    {
      this->Stream >> value;
    }
    else
    {
      this->Stream << value;
    }
  }

  vtkMultiProcessStream& Stream;
  bool Reads;
};

/// A struct of each rank, on every rank. Collective.
template <class Struct>
std::vector<Struct> AllGather(vtkMultiProcessController* ranks, Struct own)
{
  vtkMultiProcessStream sent;
  StreamedMembers(sent, false)(own);
  std::vector<vtkMultiProcessStream> streams;
  ranks->AllGather(sent, streams);
  std::vector<Struct> all(streams.size());
  for (std::size_t rank = 0; rank < all.size(); ++rank)
  {
    StreamedMembers(streams[rank], true)(all[rank]);
  }
  return all;
}

/// Whether other ranks want a filter's work to stop, which is in WorkOnAllRanks.
bool IsStoppedByOthers(vtkAlgorithm* filter);

/// Who is not where the others are.
struct MissingRank
{
  int rank = -1; ///< the first that did not come, or 0 on a rank that comes when the others have gone; -1: none
  bool elsewhere = false; ///< it came to another filter than the first rank
};

/// Waits until all ranks are here, which are about to work together, but not forever: a rank whose script does not
/// update the filter, or where the pipeline stopped before it, never comes.
///
/// They wait 600 seconds, or as many as the variable TYNDALL_RANKS_WAIT says: a filter before may take that much longer
/// on one rank than on another. Without MPI nobody waits here.
/// @param filter  that this rank is at: its class
MissingRank FindMissingRank(vtkMultiProcessController* ranks, const char* filter);
}
