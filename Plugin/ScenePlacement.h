#ifndef ScenePlacement_h
#define ScenePlacement_h

/// Has new sources begin at a place and with a size that fit what is in the pipeline already: the box around all images
/// with more than one voxel along each axis, of length L from corner to corner. Hints of properties ask for it:
///
/// - <ScenePlacement offset="X Y Z"/>: a place, this many L away from the box's centre, to L / 100.
/// - <ScenePlacement factor="F" exponent="E"/>: numbers that all are F L^E, to two digits; exponent is 1 unless it is
///   given.
///
/// A property that has another value than default_values when the source is registered keeps it, as do those of states.
///
/// To be called when the plugin is loaded; serves windows and scripts. A hint, not a domain: a script's client may know
/// the proxies of a server without having the plugin's library, and would miss a domain of it.
void FollowScenePlacement();

#endif
