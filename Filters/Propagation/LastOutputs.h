#ifndef LastOutputs_h
#define LastOutputs_h

#include "Common/ImageInput.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <array>
#include <cstdint>
#include <vector>

class vtkDataObject;
class vtkInformationVector;

namespace tyndall
{
/// In `left_out`, where outputs are those of before.
constexpr const char* LightOfBefore = "light: that of before, for the solve was stopped";

/// What a filter made last, to be given out again where it is asked for the same of the same: the pipeline may run it
/// twice for one time step (ContentKey). The arrays are those of the outputs, not copies. Outputs are whole when they
/// are kept and when they come back: the filter then hands on the piece that it was asked for.
class LastOutputs
{
public:
  /// First in RequestData. Where it gives nothing back, what it kept is only for GiveBefore.
  /// @param settings  when a property last changed that the outputs depend on
  /// @return whether the outputs are there: neither such a property nor the content of an input has changed
  /// @param axes  those of the filter: outputs that are kept and given back lie in these
  bool GiveBack(vtkMTimeType settings, const OwnAxes& axes, vtkInformationVector** inputs, int ports,
    vtkInformationVector* outputs);

  /// In RequestData, once they are made.
  void Keep(vtkInformationVector* outputs);
  /// The same where GiveBack was not asked for them.
  void Keep(vtkMTimeType settings, const OwnAxes& axes, vtkInformationVector** inputs, int ports,
    vtkInformationVector* outputs);

  /// After a run that was stopped, whose outputs are empty and said to be aborted: the outputs of the last run that was
  /// not, where the same extent is told for them. They stay marked as aborted, and `left_out` says so, too.
  /// @param axes  become those in which they lie
  /// @return whether the outputs are there
  bool GiveBefore(vtkInformationVector* outputs, OwnAxes& axes) const;

  void LetGo(); ///< but for GiveBefore
  void Forget();

private:
  using Key = std::vector<std::uint64_t>;

  static Key KeyOf(vtkMTimeType settings, const OwnAxes& axes, vtkInformationVector** inputs, int ports);

  Key MadeOf;
  std::array<int, 6> Told = {};                        ///< the extent of the whole output, when they were made
  OwnAxes Axes, AxesBefore;                            ///< of Outputs and of Before
  std::vector<vtkSmartPointer<vtkDataObject>> Outputs; ///< by port
  std::vector<vtkSmartPointer<vtkDataObject>> Before;  ///< the same, until there are others
};
}

#endif
