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

/// MPI ranks that run a filter together, each for its piece of the output.
///
/// This is the case if ParaView distributes data (pvbatch --symmetric, pvserver), and in VTK programs in which the
/// number of requested pieces equals the number of ranks. The ranks then agree by collective operations of VTK's global
/// controller, which every rank reaches even if its own part of the work failed. If fewer pieces are requested, as by
/// one rank that updates alone, ranks neither communicate nor wait.
namespace tyndall
{
class Communicator;

/// In RequestUpdateExtent: informs filters upstream of a port whether all ranks make this request together, even though
/// each requests the complete input.
void AskTogether(vtkInformation* request, vtkInformationVector* outputs, vtkInformationVector* inputs);

/// In RequestData.
/// @return the controller of the ranks that run the filter together; null: this process runs it alone
vtkMultiProcessController* RanksTogether(vtkInformation* request, vtkInformationVector* outputs);

/// In RequestUpdateExtent or RequestData: whether the number of requested pieces equals the number of ranks.
bool EachAsksForItsPiece(vtkInformation* request, vtkInformationVector* outputs);

/// Runs `act` on each rank. Collective.
/// @param controller  null: there is one rank
/// @throws on every rank what `act` threw on any rank: InvalidInput with the same message, which names the rank unless
///   all ranks threw. An abort (Aborted) and a failure upstream (InputFailed) are not errors of this filter
void OnAllRanks(vtkMultiProcessController* controller, const std::function<void()>& act);
/// Runs long work on the first rank, for which the others wait. Collective.
/// @throws on every rank what `work` threw, as Throw does (Common/Failure.h)
void OnFirstRank(vtkMultiProcessController* controller, const std::function<void()>& work);

/// The same for long work that can be stopped: if the work ends early on one rank, the filter's Monitor (MonitorOf)
/// stops it on the other ranks. Calls may be nested.
void WorkOnAllRanks(vtkMultiProcessController* controller, vtkAlgorithm* filter, const std::function<void()>& work);

/// Writes the members of a struct to a stream, or reads them. The struct lists its members once, for both directions.
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
  /// Any other struct provides a member function Stream(StreamedMembers&).
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

/// Gathers one struct from each rank on every rank, in the order of ranks. Collective.
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

double OfFirstRank(Communicator& ranks, double own);
std::string OfFirstRank(Communicator& ranks, const std::string& own);
/// Sets numbers and texts to those of the first rank. Collective.
template <class... Values>
void TakeFromFirstRank(Communicator& ranks, Values&... values)
{
  ((values = static_cast<Values>(OfFirstRank(ranks, values))), ...);
}

/// Whether the filter's work has ended early on another rank, within WorkOnAllRanks.
bool IsStoppedByOthers(vtkAlgorithm* filter);

/// A rank that did not reach the barrier.
struct MissingRank
{
  int rank = -1;          ///< the first such rank; 0 on a rank that arrives after the others gave up; -1: none
  bool elsewhere = false; ///< that rank reached another filter than the first rank
};

/// A barrier with a timeout (SecondsToWait). A rank never arrives if its script does not update the filter, or if its
/// pipeline stopped upstream. Without MPI there is no barrier.
/// @param filter  class name of the filter that this rank has reached
MissingRank FindMissingRank(vtkMultiProcessController* ranks, const char* filter);
}
