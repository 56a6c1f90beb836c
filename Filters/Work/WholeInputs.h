#pragma once

#include "Common/ImageInput.h"

#include "vtkNew.h"
#include "vtkSmartPointer.h"

#include <functional>
#include <memory>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;
class vtkInformation;
class vtkInformationVector;
class vtkMultiProcessController;

namespace tyndall
{
/// In RequestData: what a filter is given, the same on all ranks that run it together (Ranks.h).
///
/// Filters whose light crosses the borders of pieces ask for the whole of their inputs (AskForAll, WholeImage.h). Many
/// sources give it to every rank; then nothing is copied and nothing is sent but a number that says so. Others have
/// only what lies on their rank: Resample To Image, a source of pieces of one's own, a file's reader where the file is
/// on one rank alone. Then each rank gets all of it: pieces of an image are put together (GatheredImage.h), with cell
/// and point arrays, ghost cells once; of other data, as tables and lights, what one rank alone has goes to all.
/// Points in shares are put one after the other, by rank.
///
/// Images that a filter reads as voxels have axes along those of the world, where theirs are so in another order. Where
/// the first input is turned otherwise, the filter works in its axes (OwnAxes), which all ranks know. Those
/// of which it reads arrays of points have a voxel around each of them (Common/ImageInput.h), also where
/// one process is alone. Of a plane of points that pieces share, the voxels are those of the lowest rank.
///
/// Memory of each rank: the whole image, and one piece of one array.
class WholeInputs
{
public:
  static constexpr int NoPort = -1;

  /// @param ranks  null: this process is alone, and has what it is given
  /// @param given  by port
  /// @param outputs  notes for KeepWhatIsAskedFor what each rank is asked for
  /// @param inPieces  a port that stays as it is given until MakeWhole, and which Replace is of
  /// @param alsoInPieces  others that stay so, too
  /// @param inShares  another, of points of which ranks may have some each (photons): together they are all
  /// @throws InvalidInput on all ranks with the same words where pieces make no whole
  WholeInputs(vtkMultiProcessController* ranks, vtkAlgorithm* filter, vtkInformationVector** given,
    vtkInformationVector* outputs, int inPieces = NoPort, int inShares = NoPort,
    const std::vector<int>& alsoInPieces = {});
  ~WholeInputs();

  /// By port.
  vtkInformationVector** Vectors() { return this->Ports.data(); }

  /// Puts outputs that were made in axes of the medium's own into the scene.
  void PutIntoScene(vtkInformationVector* outputs);

  /// Data instead of those of the first port that was left in pieces; until MakeWhole.
  void Replace(vtkDataObject* data);

  /// Of the ports that were left as they are given. All ranks have to call it.
  /// @throws InvalidInput as the constructor
  void MakeWhole();

private:
  struct Seen; ///< of the inputs, on all ranks
  void MakeWhole(int port);
  using ToOther = std::function<vtkSmartPointer<vtkDataObject>(int connection, vtkDataObject* data)>;
  void AlignGiven(vtkInformationVector** given);
  void AgreeOnAxes(vtkMultiProcessController* ranks);
  void TurnGiven();
  void NoteAveragedArrays();
  void Change(int port, const ToOther& change);

  vtkAlgorithm* Filter;
  std::vector<vtkSmartPointer<vtkInformationVector>> Given; ///< by port, images with aligned axes
  OwnAxes Axes;                                             ///< of the first port's
  vtkSmartPointer<vtkDataObject> Medium;                    ///< the same image as it is in the scene; null: none is

  std::unique_ptr<Seen> AllSeen; ///< null: this process is alone
  std::vector<vtkSmartPointer<vtkInformationVector>> Kept;
  std::vector<vtkInformationVector*> Ports;
};
}
