#ifndef LastOutputs_h
#define LastOutputs_h

#include "Common/ImageInput.h"
#include "Light/KeptLight.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

class vtkDataObject;
class vtkInformationVector;

namespace tyndall
{
/// Entry of `left_out` if the outputs are those of the previous complete run.
constexpr const char* LightOfBefore = "light: that of before, for the solve was stopped";

/// Solution that a solver keeps as the first guess of the next update if WarmStart is on.
class LastLight
{
public:
  /// Storage to pass to the solver. If `warmStart` is false, frees the storage and returns null.
  KeptLight* Where(bool warmStart)
  {
    if (!warmStart)
    {
      this->Kept.reset();
    }
    else if (!this->Kept)
    {
      this->Kept = std::make_unique<KeptLight>();
    }
    return this->Kept.get();
  }

private:
  std::unique_ptr<KeptLight> Kept;
};

/// Cache of a filter's last outputs, returned again for the same inputs: the pipeline may run a filter twice for one
/// time step (ContentKey). Arrays are shared, not copied. The cached outputs are not yet cropped to the requested
/// extent.
class LastOutputs
{
public:
  /// What the outputs depend on: the inputs' content, the time of the last property change, the filter's own axes.
  using Key = std::vector<std::uint64_t>;
  static Key KeyOf(vtkMTimeType settings, const OwnAxes& axes, vtkInformationVector** inputs, int ports);

  /// Copies the cached outputs to `outputs` if they were computed for this key.
  /// @return whether they were; if not, the cache is from then on available to GiveBefore only
  bool GiveBack(const Key& key, vtkInformationVector* outputs);

  /// @param axes  axes of the outputs' grids
  void Keep(Key key, const OwnAxes& axes, vtkInformationVector* outputs);

  /// After an aborted run, whose outputs are empty: copies the outputs of the last complete run to `outputs`, if their
  /// whole extent is the same. They stay marked as aborted, and `left_out` reports it.
  /// @param axes  set to the axes of these outputs' grids
  /// @return whether there were such outputs
  bool GiveBefore(vtkInformationVector* outputs, OwnAxes& axes) const;

  void LetGo(); ///< makes the cached outputs available to GiveBefore only
  void Forget();

private:
  Key MadeOf;
  std::array<int, 6> Told = {};                        ///< whole extent of output 0 when the outputs were computed
  OwnAxes Axes, AxesBefore;                            ///< axes of Outputs and of Before
  std::vector<vtkSmartPointer<vtkDataObject>> Outputs; ///< outputs of the last key, by port
  std::vector<vtkSmartPointer<vtkDataObject>> Before;  ///< outputs of the last complete run, for GiveBefore, by port
};
}

#endif
