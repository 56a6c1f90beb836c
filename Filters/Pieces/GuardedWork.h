#pragma once

#include "Device/Monitor.h"

#include <functional>
#include <vector>

class vtkAlgorithm;
class vtkInformation;
class vtkInformationVector;
class vtkMultiProcessController;

/// Work of a filter that may fail, be stopped, and tells how far it is.
namespace tyndall
{
class WholeInputs;

/// Reports to the filter's progress; says stop when the filter is asked to abort, on this rank or another.
Monitor MonitorOf(vtkAlgorithm* filter);

/// Runs the work of a filter's RequestData. Whatever it throws becomes one error of the filter; the outputs are empty
/// then and after an abort, which is no error, and the filter runs again when something has changed. Empty outputs have
/// field data `failed` or `aborted`, from which later filters know: they stay empty, too, without an error of their
/// own. While the device's compiler works the filter's progress text says so. What the device layer has to tell users
/// (Device::TakeWarnings) becomes a warning of the filter.
/// @return what RequestData is to return: always 1. With 0 the pipeline would add an error that says less, and run the
///   filter again, in vain, with every update.
int Guarded(vtkAlgorithm* filter, vtkInformationVector* outputs, const std::function<void()>& work);

/// The same of a filter that needs all of its inputs, whatever piece is asked for.
///
/// Where ranks run it together (Ranks.h), what fails on one of them is one error on all, with the same words, and the
/// outputs of all are empty; so it is with an abort. One that does not come is an error
/// after a while (RankMeeting.h).
/// @param given  the inputs of RequestData
/// @param work   is given them as wholes (WholeInputs.h), the same on all ranks
int Guarded(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs,
  const std::function<void(vtkInformationVector** inputs)>& work);

/// The same of a filter that may do with pieces of one of its inputs where ranks run it together.
/// @param port  of that
/// @param work  is given the ranks (null: there is one) and the inputs, those of that port as they are: it may make
///   them whole
/// @param shares  another port, of points of which ranks may have some each (WholeInputs.h); -1: none
/// @param others  ports that stay as they are, too
int GuardedInPieces(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given,
  vtkInformationVector* outputs, int port,
  const std::function<void(vtkMultiProcessController* ranks, WholeInputs& inputs)>& work, int shares = -1,
  const std::vector<int>& others = {});

/// Work on the piece of an input that a rank has, without any rank having all of it.
struct WorkOnPieces
{
  int port = 0; ///< the input of which ranks have pieces; the others are whole
  /// Called first, on all ranks together. Its answer is the same on all: false where it does nothing.
  /// @param ranks  null: this process is alone; output 0 is then cut to what was asked for
  std::function<bool(vtkMultiProcessController* ranks, vtkInformationVector** inputs)> work;
  int shares = -1;              ///< an input of points of which ranks may have some each, as they are given; -1: none
  std::vector<int> others = {}; ///< further inputs that stay in pieces
};

/// The same, where it may do with pieces; where not, `work` is given wholes.
int Guarded(vtkAlgorithm* filter, vtkInformation* request, vtkInformationVector** given, vtkInformationVector* outputs,
  const WorkOnPieces& onPieces, const std::function<void(vtkInformationVector** inputs)>& work);

/// After Guarded: whether outputs are empty because it failed, or was aborted.
bool AreEmptied(vtkInformationVector* outputs);

/// Runs what may fail in a reader's RequestInformation. What it throws becomes one error, however often ParaView asks,
/// until the reader is modified; Guarded then leaves the outputs empty.
/// @return whether it succeeded. RequestInformation is to return 1 all the same, as RequestData.
bool GuardedInformation(vtkAlgorithm* filter, const std::function<void()>& work);
}
