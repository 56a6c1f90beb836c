#pragma once

#include "Device/Monitor.h"

#include <functional>
#include <vector>

class vtkAlgorithm;
class vtkInformation;
class vtkInformationVector;
class vtkMultiProcessController;

/// Runs the work of a filter that may fail or be stopped, and reports progress.
namespace tyndall
{
class Communicator;
class PieceBlocks;
class WholeInputs;

/// Makes a monitor that reports progress to the filter, and requests a stop if an abort of the filter is requested on
/// any rank.
Monitor MonitorOf(vtkAlgorithm* filter);

/// Runs the work of a filter's RequestData. Any exception becomes one error of the filter and empties the outputs. An
/// abort empties them without an error; the filter runs again once something has changed. Empty outputs have field data
/// `failed` or `aborted` (Common/Failure.h), which keep filters downstream empty without further errors. While the
/// device's compiler works, the filter's progress text says so. Warnings of the device layer (Device::TakeWarnings)
/// become warnings of the filter. The run time becomes the filter's property Seconds (SecondsOfRun).
/// @return the value for RequestData to return, always 1: with 0 the pipeline would add a less specific error, and
///   would run the filter again, without effect, on every update
int Guarded(vtkAlgorithm* filter, vtkInformationVector* outputs, const std::function<void()>& work);

/// Runs the work of a filter's RequestData, with the handling of errors and aborts of Guarded(filter, outputs, work),
/// for a filter that needs its complete inputs, whatever piece of the output is requested.
///
/// If ranks run the filter together (Ranks.h), an error on one rank becomes the same error on all, and the outputs of
/// all ranks are empty, as after an abort. A rank that does not arrive causes an error after a timeout
/// (FindMissingRank).
/// @param given  the inputs of RequestData
/// @param work   called with the complete inputs (WholeInputs.h), the same on all ranks
int Guarded(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs,
  const std::function<void(vtkInformationVector** inputs)>& work);

/// Work of a filter on an image that may be distributed in pieces among ranks. The same function `work` is called for
/// every number of ranks.
///
/// If wantsPieces returns true on a rank, and the pieces make up one grid, each rank works on its subdomain. Otherwise
/// the inputs are gathered on the first rank, which works on them and distributes the outputs: each rank receives the
/// part of each image that is requested from it, with field data, and the tables at ports above 0; other data stay on
/// the first rank.
struct WorkOnSubdomains
{
  int port = 0;                 ///< port of the image that is decomposed; inputs at other ports are gathered
  int shares = -1;              ///< port of points (photons) that stay distributed among ranks; -1: none
  std::vector<int> others = {}; ///< further ports whose data stay in pieces
  /// Whether this rank would work on its piece; one such rank suffices to decompose the domain. Null: no rank would.
  std::function<bool(vtkInformationVector** inputs)> wantsPieces;
  /// The work itself, on `pieces`. Collective if the domain is decomposed; the function may then return false, on all
  /// ranks, to be called again on the first rank. Output 0 is cropped to the requested extent unless several ranks made
  /// it.
  std::function<bool(const PieceBlocks& pieces, vtkInformationVector** inputs)> work;
  /// Sends the results that the filter keeps in its members (read-only properties) from the first rank to the other
  /// ranks. The first rank has worked alone. Collective.
  std::function<void(Communicator& ranks)> shareResults;
  /// Whether each rank works on the complete inputs, instead of the first rank alone; worth it if the work takes less
  /// time than sending the outputs.
  bool wholeOnEachRank = false;
  /// Whether the extents of the output images become known only when the work is done; each rank then makes the
  /// complete images.
  bool tellsExtents = false;
};
int Guarded(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs,
  const WorkOnSubdomains& work);

/// Runs the work of a filter's RequestData, as Guarded does, for a filter that decides itself how to work on the pieces
/// of one input.
/// @param port  port of the input that stays in pieces
/// @param work  called with the controller (null: one rank) and the inputs; the input at `port` is in pieces. It may
///   call WholeInputs::MakeWhole
int GuardedInPieces(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given,
  vtkInformationVector* outputs, int port,
  const std::function<void(vtkMultiProcessController* ranks, WholeInputs& inputs)>& work);

/// To be called during the work if this run returns cached outputs of an earlier run. The property Seconds then keeps
/// the time of that run.
void NoteGivenBack(vtkAlgorithm* filter);

/// Whether the outputs are empty because the filter failed or was aborted. Called after Guarded.
bool AreEmptied(vtkInformationVector* outputs);

/// Runs code of a reader's RequestInformation that may fail. An exception is reported as one error, however often
/// ParaView asks, until the reader is modified; after such an error Guarded leaves the outputs empty.
/// @return true if no exception was thrown. The caller returns 1 from RequestInformation either way: 0 would make the
///   pipeline add a second error.
bool GuardedInformation(vtkAlgorithm* filter, const std::function<void()>& work);
}
