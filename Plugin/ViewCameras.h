#ifndef ViewCameras_h
#define ViewCameras_h

/// Has sources take the camera of a 3D view, where their hints ask for it:
///
///     <ViewCamera button="NAME" follow="NAME" elsewhere="1">
///       <Property name="NAME" of="NAME" from="NAME"/>
///     </ViewCamera>
///
/// Each Property is set to what the property `of` of the view is (CameraPosition, ...), or, with `from`, to the vector
/// from that property of the view to it, when the source's command `button` is called (its button on the panel, or
/// InvokeCommand in Python), and, while its property `follow` is not 0, whenever the view has been drawn with another
/// camera. The view is the active one, or else the first one, that has a camera; with `elsewhere` one that does not
/// show the source itself. Views that show it are drawn again.
///
/// To be called when the plugin is loaded; serves windows and scripts.
void FollowViewCameras();

#endif
