#ifndef RunningFilters_h
#define RunningFilters_h

/// Gives ParaView's window what version 5.11 lacks while a filter runs, for proxies with the hint <StopsOnAbort/>:
///
/// - The abort button in the status bar works. ParaView has one, but never enables it, and does not listen to it.
///   Pressed, it makes the filter's CheckAbort true. Filters on a server are out of its reach. Then the status bar says
///   that the filter was stopped, and Apply runs it again (StoppedFilters.h).
/// - The results on the panel (information_only) are those of the last run. ParaView reads them before the run that an
///   Apply leads to.
///
/// To be called when the plugin is loaded. Where there is no window (pvpython, pvbatch, pvserver) it does nothing.
void FollowRunningFilters();

#endif
