// What the test of the layers must find.
#include <vtkImageData.h>
