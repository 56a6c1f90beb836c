#pragma once

/// Registers si_class vtkSIExtentAfterUpdateProxy with a server, for sources and filters whose whole extent may change
/// during an update: for example because the files of a time series differ in extent.
///
/// ParaView appends a vtkPVPostFilter to each output, which converts arrays for downstream filters. The post filter
/// copies the whole extent only in RequestInformation, before VTK requests a time step. Representations would crop the
/// image to that outdated extent, or look for its faces there. Therefore this class copies the filter's whole extent
/// downstream each time the post filter has run.
void TeachExtentAfterUpdate();
