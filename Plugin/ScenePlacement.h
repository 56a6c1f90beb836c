#ifndef ScenePlacement_h
#define ScenePlacement_h

/// Teaches ParaView the domain <SceneDomain/>, by which a new source begins at a place and with a size that fit what is
/// in the pipeline already: the box around all images with more than one voxel along each axis, of length L from corner
/// to corner. Where there is none, the property has its default_values.
///
/// - <SceneDomain name="scene" offset="X Y Z"/>: a place, this many L away from the box's centre, to L / 100.
/// - <SceneDomain name="scene" factor="F" exponent="E"/>: numbers that all are F L^E, to two digits; exponent is 1
///   unless it is given.
///
/// As with ParaView's own domains, a value that a script gives when it makes the source stays.
/// To be called when the plugin is loaded; serves windows and scripts.
void TeachScenePlacement();

#endif
