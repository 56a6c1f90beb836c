#pragma once

/// Registers si_class vtkSINumberByNumberProperty with a server. It makes ParaView call a property's command once per
/// number, whatever number_of_elements_per_command is. That attribute defines the rows on the panel, and ParaView
/// silently drops an incomplete row; a filter that gets all numbers can report what is missing.
void TeachNumberByNumber();
