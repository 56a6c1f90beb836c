#ifndef ScenePlacement_h
#define ScenePlacement_h

/// Initialises position and size of new sources to fit the scene: the bounding box, with diagonal L, of all images with
/// more than one voxel along each axis. Properties request it by hints:
///
/// - <ScenePlacement offset="X Y Z"/>: a position at the box's centre + L (X, Y, Z), rounded to about L / 100.
/// - <ScenePlacement factor="F" exponent="E"/>: all numbers are F L^E, rounded to two digits; E is 1 by default.
///
/// A property whose value differs from default_values when the source is registered keeps that value, for example in
/// loaded states.
///
/// Installs the observers that apply the hint <ScenePlacement>. To be called when the plugin is loaded; works in
/// windows and in scripts. ScenePlacement is a hint, not a domain, because a script's client may know a server's
/// proxies without having loaded the plugin's library, which would define the domain.
void FollowScenePlacement();

#endif
