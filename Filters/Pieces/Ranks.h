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

/// MPI ranks that run a filter together, each rank for its piece of the output.
///
/// Ranks run filters together if ParaView distributes data (pvbatch --symmetric, pvserver), and in VTK programs in
/// which the number of requested pieces equals the number of ranks. The ranks then agree by collective operations of
/// VTK's global controller, which every rank reaches even if its own part of the work failed. If fewer pieces are
/// requested, as by one rank that updates alone, ranks neither communicate nor wait.
namespace tyndall
{
class Communicator;

/// In RequestUpdateExtent: informs filters upstream of a port whether all ranks make this request together. These
/// filters cannot infer it, because independent ranks, too, may each request the complete input.
void AskTogether(vtkInformation* request, vtkInformationVector* outputs, vtkInformationVector* inputs);

/// Determines in RequestData whether ranks run the filter together.
/// @return the controller of these ranks; null: this process runs the filter alone
vtkMultiProcessController* RanksTogether(vtkInformation* request, vtkInformationVector* outputs);

/// Whether the number of requested pieces equals the number of ranks. Called in RequestUpdateExtent or RequestData.
bool EachAsksForItsPiece(vtkInformation* request, vtkInformationVector* outputs);

/// Runs `act` on each rank, and reports an error of one rank on all. Collective.
/// @param controller  null: there is one rank
/// @throws on every rank what `act` threw on any rank: InvalidInput with the same message, which names the rank unless
///   all ranks threw. An abort (Aborted) and a failure upstream (InputFailed) are not errors of this filter
void OnAllRanks(vtkMultiProcessController* controller, const std::function<void()>& act);
/// Runs long work on the first rank only, while the other ranks wait. Collective.
/// @throws on every rank what `work` threw on the first one: Aborted, InputFailed, InputIsEmpty, or InvalidInput for
///   any other exception
void OnFirstRank(vtkMultiProcessController* controller, const std::function<void()>& work);

/// Runs long work on each rank, as OnAllRanks does, and stops it on all ranks if it ends early on one: the filter's
/// Monitor (MonitorOf) then requests a stop. Collective. Calls may be nested.
void WorkOnAllRanks(vtkMultiProcessController* controller, vtkAlgorithm* filter, const std::function<void()>& work);

/// Stream to which the members of a struct are written, or from which they are read. The struct lists its members once,
/// for both directions.
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
  /// Streams a struct that is neither a number nor a text: it provides a member function Stream(StreamedMembers&).
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
/// Replaces values (numbers, texts) by those on the first rank. Collective.
template <class... Values>
void TakeFromFirstRank(Communicator& ranks, Values&... values)
{
  ((values = static_cast<Values>(OfFirstRank(ranks, values))), ...);
}

/// Whether another rank has ended the filter's work early. To be called within WorkOnAllRanks.
bool IsStoppedByOthers(vtkAlgorithm* filter);

/// A rank that did not reach the barrier of FindMissingRank.
struct MissingRank
{
  /// Number of the first rank that did not reach the barrier; -1: all ranks reached it. A rank that arrives after the
  /// timeout gets no answer from rank 0, and reports rank 0 as missing.
  int rank = -1;
  bool elsewhere = false; ///< whether `rank` reached the barrier in another filter than the first rank
};

/// Waits, up to a timeout (SecondsToWait), until all ranks reach this barrier, and returns the first rank that did not.
/// A rank never arrives if its script does not update the filter, or if its pipeline stopped upstream. Without MPI
/// there is no barrier.
/// @param filter  class name of the filter that runs on this rank
MissingRank FindMissingRank(vtkMultiProcessController* ranks, const char* filter);
}
