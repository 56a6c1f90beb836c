#pragma once

/// Teaches a server sources and filters of si_class vtkSIExtentAfterUpdateProxy, whose images may have another extent
/// than was known before they were made: another time's file of a series has another box.
///
/// ParaView puts a vtkPVPostFilter behind each output, which converts arrays for the filters behind it. It copies the
/// whole extent when information is asked for, before VTK says of what time data are wanted, and not again.
/// Representations would cut the image to that extent, or look for its faces there. So the filter's whole extent is
/// passed on whenever the post filter has passed on its data.
void TeachExtentAfterUpdate();
