#ifndef LastOutputs_h
#define LastOutputs_h

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <cstdint>
#include <vector>

class vtkAlgorithm;
class vtkDataObject;
class vtkInformationVector;

namespace tyndall
{
/// What a filter made last, to be given out again where it is asked for the same of the same: the pipeline may run it
/// twice for one time step (ContentKey.h). The arrays are those of the outputs, not copies.
class LastOutputs
{
public:
  /// First in RequestData. Where it gives nothing back, it has let go what it kept.
  /// @return whether the outputs are there: neither a property nor the content of an input has changed
  bool GiveBack(vtkAlgorithm* filter, vtkInformationVector** inputs, vtkInformationVector* outputs);

  /// Last in RequestData, which has succeeded.
  void Keep(vtkInformationVector* outputs);

private:
  using Key = std::vector<std::uint64_t>;

  static Key KeyOf(vtkAlgorithm* filter, vtkInformationVector** inputs, vtkInformationVector* outputs);

  Key MadeOf;
  std::vector<vtkSmartPointer<vtkDataObject>> Outputs; ///< by port
};
}

#endif
