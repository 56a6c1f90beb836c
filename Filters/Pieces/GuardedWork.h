#pragma once

#include "Device/Monitor.h"

#include <functional>
#include <vector>

class vtkAlgorithm;
class vtkInformation;
class vtkInformationVector;
class vtkMultiProcessController;

/// Work of a filter that may fail or be stopped, and reports progress.
namespace tyndall
{
class PieceBlocks;
class WholeInputs;

/// Reports to the filter's progress; asks to stop if the filter is to abort, on this rank or another.
Monitor MonitorOf(vtkAlgorithm* filter);

/// Runs the work of a filter's RequestData. Whatever it throws becomes one error of the filter; the outputs are empty
/// then, and after an abort, which is no error, and the filter runs again once something has changed. Empty outputs
/// have field data `failed` or `aborted` (Common/Failure.h), by which filters downstream stay empty without an error of
/// their own. While the device's compiler works the filter's progress text says so. Warnings of the device layer
/// (Device::TakeWarnings) become warnings of the filter.
/// @return what RequestData is to return: always 1. With 0 the pipeline would add an error that says less, and run the
///   filter again, in vain, with every update.
int Guarded(vtkAlgorithm* filter, vtkInformationVector* outputs, const std::function<void()>& work);

/// The same for a filter that needs all of its inputs, whatever piece is asked for.
///
/// If ranks run it together (Ranks.h), an error on one of them is the same error on all, and the outputs of all are
/// empty; so are they after an abort. A rank that does not arrive times out with an error (FindMissingRank).
/// @param given  the inputs of RequestData
/// @param work   called with all of them (WholeInputs.h), the same on all ranks
int Guarded(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs,
  const std::function<void(vtkInformationVector** inputs)>& work);

/// Work on subdomains: one function, whether each rank has a piece of an image or one rank has all of it.
struct WorkOnSubdomains
{
  int port = 0;                 ///< the input image that is decomposed; other inputs are whole
  int shares = -1;              ///< an input of points that are distributed among ranks, as they are given; -1: none
  std::vector<int> others = {}; ///< further inputs that stay in pieces
  /// Whether this rank would work on its piece; one rank is enough.
  std::function<bool(vtkInformationVector** inputs)> wantsPieces;
  /// The work. Collective if the domain is decomposed; then it may return false, on all ranks, to be called again with
  /// all of the inputs on each rank. Output 0 is cropped to what is asked for, unless several ranks have made it.
  std::function<bool(const PieceBlocks& pieces, vtkInformationVector** inputs)> work;
};
int Guarded(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs,
  const WorkOnSubdomains& work);

/// The same for a filter that decides itself how to work on pieces of one of its inputs.
/// @param port  of that
/// @param work  called with the ranks (null: there is one) and the inputs, those of that port as they are; it may call
///   WholeInputs::MakeWhole
/// @param shares, others  as in WorkOnSubdomains
int GuardedInPieces(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given,
  vtkInformationVector* outputs, int port,
  const std::function<void(vtkMultiProcessController* ranks, WholeInputs& inputs)>& work, int shares = -1,
  const std::vector<int>& others = {});

/// Work on the piece of an input that a rank has, without any rank having all of it.
struct WorkOnPieces
{
  int port = 0; ///< the input of which ranks have pieces; other inputs are whole
  /// Called first. Collective; returns the same on all ranks: false if it does nothing.
  /// @param ranks  null: this process is alone; output 0 is then cropped to what was asked for
  std::function<bool(vtkMultiProcessController* ranks, vtkInformationVector** inputs)> work;
  int shares = -1;              ///< as in WorkOnSubdomains
  std::vector<int> others = {}; ///< the same
};

/// The same with WorkOnPieces; if that does nothing, `work` is called with all of the inputs.
int Guarded(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs,
  const WorkOnPieces& onPieces, const std::function<void(vtkInformationVector** inputs)>& work);

/// After Guarded: whether outputs are empty because the filter failed or was aborted.
bool AreEmptied(vtkInformationVector* outputs);

/// Runs what may fail in a reader's RequestInformation. What it throws becomes one error, however often ParaView asks,
/// until the reader is modified; Guarded then leaves the outputs empty.
/// @return whether it succeeded. RequestInformation is to return 1 all the same, as RequestData.
bool GuardedInformation(vtkAlgorithm* filter, const std::function<void()>& work);
}
