#pragma once

/// Registers si_class vtkSINumberByNumberProperty with a server. Properties of this class call their command once per
/// number. By default ParaView calls the command once per row of number_of_elements_per_command numbers, and silently
/// drops an incomplete row; a filter that gets all numbers can report the missing ones.
void TeachNumberByNumber();
