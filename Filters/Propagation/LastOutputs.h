#ifndef LastOutputs_h
#define LastOutputs_h

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <cstdint>
#include <vector>

class vtkDataObject;
class vtkInformationVector;

namespace tyndall
{
/// What a filter made last, to be given out again where it is asked for the same of the same: the pipeline may run it
/// twice for one time step (ContentKey.h). The arrays are those of the outputs, not copies. Outputs are whole when they
/// are kept and when they come back: the filter then hands on the piece that it was asked for.
class LastOutputs
{
public:
  /// First in RequestData. Where it gives nothing back, it has let go what it kept.
  /// @param settings  when a property last changed that the outputs depend on
  /// @return whether the outputs are there: neither such a property nor the content of an input has changed
  bool GiveBack(vtkMTimeType settings, vtkInformationVector** inputs, int ports, vtkInformationVector* outputs);

  /// In RequestData, once they are made.
  void Keep(vtkInformationVector* outputs);
  /// The same where GiveBack was not asked for them.
  void Keep(vtkMTimeType settings, vtkInformationVector** inputs, int ports, vtkInformationVector* outputs);

  void Forget() { this->Outputs.clear(); }

private:
  using Key = std::vector<std::uint64_t>;

  static Key KeyOf(vtkMTimeType settings, vtkInformationVector** inputs, int ports);

  Key MadeOf;
  std::vector<vtkSmartPointer<vtkDataObject>> Outputs; ///< by port
};
}

#endif
