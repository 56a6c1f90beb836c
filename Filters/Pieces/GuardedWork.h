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

/// Makes a monitor that reports progress to the filter, and requests a stop if the filter is to abort on any rank.
Monitor MonitorOf(vtkAlgorithm* filter);

/// Runs the work of a filter's RequestData. Any exception becomes one error of the filter and empties the outputs. So
/// does an abort, but without an error; the filter runs again once something has changed. Empty outputs have field data
/// `failed` or `aborted` (Common/Failure.h), which keep filters downstream empty without further errors. While the
/// device's compiler works, the filter's progress text says so. Warnings of the device layer (Device::TakeWarnings)
/// become warnings of the filter.
/// @return the value for RequestData to return, always 1: with 0 the pipeline would add a less specific error, and run
///   the filter again, in vain, on every update
int Guarded(vtkAlgorithm* filter, vtkInformationVector* outputs, const std::function<void()>& work);

/// The same for a filter that needs all of its inputs, whatever piece of the output is requested.
///
/// If ranks run the filter together (Ranks.h), an error on one rank becomes the same error on all, and the outputs of
/// all ranks are empty, as after an abort. A rank that does not arrive causes an error after a timeout
/// (FindMissingRank).
/// @param given  the inputs of RequestData
/// @param work   called with the complete inputs (WholeInputs.h), the same on all ranks
int Guarded(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs,
  const std::function<void(vtkInformationVector** inputs)>& work);

/// Work on an image that may lie in pieces on several ranks. One function serves every number of ranks.
///
/// If a rank wants pieces, and the pieces make up one grid, each rank works on its subdomain. Else the first rank works
/// on the complete inputs, gathered there, and the outputs are distributed: each rank gets the part of each image that
/// it is asked for, with its field data, and the tables at ports above 0; other data stay on the first rank.
struct WorkOnSubdomains
{
  int port = 0;                 ///< port of the image that is decomposed; inputs at other ports are gathered
  int shares = -1;              ///< port of points that stay distributed among ranks; -1: none
  std::vector<int> others = {}; ///< further ports that stay in pieces
  /// Whether this rank would work on its piece. One such rank suffices. Null: none would.
  std::function<bool(vtkInformationVector** inputs)> wantsPieces;
  /// Does the work. Collective if the domain is decomposed; it may then return false, on all ranks, to be called again
  /// on the first rank. Output 0 is cropped to the requested extent unless several ranks made it.
  std::function<bool(const PieceBlocks& pieces, vtkInformationVector** inputs)> work;
  /// Gives the other ranks the results that the filter's members report, after the first rank has worked. Collective.
  std::function<void(Communicator& ranks)> shareResults;
  /// Whether each rank works on the complete inputs, not the first for all: if that costs less than to send the
  /// outputs.
  bool wholeOnEachRank = false;
  /// Whether the extents of the output images become known by the work only; each rank then makes them complete.
  bool tellsExtents = false;
};
int Guarded(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs,
  const WorkOnSubdomains& work);

/// The same for a filter that decides itself how to work on the pieces of one input.
/// @param port  port of that input
/// @param work  called with the controller (null: one rank) and the inputs, that of `port` still in pieces; it may call
///   WholeInputs::MakeWhole
int GuardedInPieces(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given,
  vtkInformationVector* outputs, int port,
  const std::function<void(vtkMultiProcessController* ranks, WholeInputs& inputs)>& work);

/// After Guarded: whether the outputs are empty because the filter failed or was aborted.
bool AreEmptied(vtkInformationVector* outputs);

/// Runs code of a reader's RequestInformation that may fail. An exception is reported as one error, however often
/// ParaView asks, until the reader is modified; Guarded then leaves the outputs empty.
/// @return true if no exception was thrown. The caller returns 1 from RequestInformation either way: 0 would make the
///   pipeline add a second error.
bool GuardedInformation(vtkAlgorithm* filter, const std::function<void()>& work);
}
