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
/// In `left_out` if outputs are those of before.
constexpr const char* LightOfBefore = "light: that of before, for the solve was stopped";

/// The light that a solver keeps from one update to the next if WarmStart is on.
class LastLight
{
public:
  /// The argument of a solver. Null if nothing is to be kept; what was kept is then dropped.
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

/// The last outputs of a filter, returned again for the same inputs: the pipeline may run a filter twice for one time
/// step (ContentKey). Arrays are shared, not copied. Outputs are kept before they are cropped to what is asked for.
class LastOutputs
{
public:
  /// What outputs depend on: content of the inputs, when a property last changed, the axes of the filter.
  using Key = std::vector<std::uint64_t>;
  static Key KeyOf(vtkMTimeType settings, const OwnAxes& axes, vtkInformationVector** inputs, int ports);

  /// @return whether the outputs are those of the key; if not, what was kept serves GiveBefore alone
  bool GiveBack(const Key& key, vtkInformationVector* outputs);

  /// @param axes  in which the outputs lie
  void Keep(Key key, const OwnAxes& axes, vtkInformationVector* outputs);

  /// After a run that was stopped, whose outputs are empty: those of the last complete run, if the same extent is
  /// announced for them. They stay marked as aborted, and `left_out` says so.
  /// @param axes  set to those in which they lie
  /// @return whether there are any
  bool GiveBefore(vtkInformationVector* outputs, OwnAxes& axes) const;

  void LetGo(); ///< keeps them for GiveBefore alone
  void Forget();

private:
  Key MadeOf;
  std::array<int, 6> Told = {};                        ///< whole extent of output 0 when they were made
  OwnAxes Axes, AxesBefore;                            ///< of Outputs and of Before
  std::vector<vtkSmartPointer<vtkDataObject>> Outputs; ///< by port
  std::vector<vtkSmartPointer<vtkDataObject>> Before;  ///< the same, until there are others
};
}

#endif
