#pragma once

/// Teaches a server properties of si_class vtkSINumberByNumberProperty: their command is called with each number,
/// whatever number_of_elements_per_command says. That makes the rows of the panel, and ParaView drops a row that is not
/// whole without a word; the filter that gets all numbers can say what is missing.
void TeachNumberByNumber();
