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
/// Entry of field data `left_out` if a solve was aborted and the outputs are those of the last complete solve.
constexpr const char* LightOfBefore = "light: that of before, for the solve was stopped";

/// Solution that a filter keeps as the initial guess of the next solve if WarmStart is on.
class LastLight
{
public:
  /// Returns the storage to pass to the solver, empty before the first solve. If `warmStart` is false, frees the
  /// storage and returns null.
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

/// Cache of a filter's last outputs, which are returned again for inputs with the same content (ContentKey): the
/// pipeline may run a filter twice for one time step. Arrays are shared, not copied. Cached outputs are not cropped to
/// the requested extent.
class LastOutputs
{
public:
  /// Cache key: the time of the last property change, the axes in which the filter works (OwnAxes), and hashes of the
  /// inputs' content.
  using Key = std::vector<std::uint64_t>;
  static Key KeyOf(vtkMTimeType settings, const OwnAxes& axes, vtkInformationVector** inputs, int ports);

  /// Copies the cached outputs to `outputs` if they were computed for this key.
  /// @return whether the outputs were copied; if not, only GiveBefore can use the cached outputs from now on
  bool GiveBack(const Key& key, vtkInformationVector* outputs);

  /// Caches the outputs of a solve.
  /// @param axes  axes of the outputs' grids
  void Keep(Key key, const OwnAxes& axes, vtkInformationVector* outputs);

  /// Copies the outputs of the last complete solve to `outputs` after an aborted solve, if the whole extent of the
  /// image is unchanged. The copies are marked as aborted, with the entry LightOfBefore in field data `left_out`.
  /// @param axes  set to the axes of the copied outputs' grids
  /// @return whether outputs were copied
  bool GiveBefore(vtkInformationVector* outputs, OwnAxes& axes) const;

  void LetGo(); ///< makes the cached outputs available to GiveBefore only
  void Forget();

private:
  Key MadeOf;
  std::array<int, 6> Told = {};                        ///< whole extent of output 0 when the outputs were computed
  OwnAxes Axes, AxesBefore;                            ///< axes of the grids in Outputs, and in Before
  std::vector<vtkSmartPointer<vtkDataObject>> Outputs; ///< outputs for the cache key MadeOf, by port
  std::vector<vtkSmartPointer<vtkDataObject>> Before;  ///< outputs of the last complete solve, for GiveBefore, by port
};
}

#endif
