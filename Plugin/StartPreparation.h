#ifndef StartPreparation_h
#define StartPreparation_h

/// Starts TyndallPreparation, the program in the plugin's folder that compiles the OpenCL kernels of the default
/// pipeline while the user loads data. The program is started by ParaView's window and by pvserver's first process, not
/// by scripts (pvpython, pvbatch), which start their own work at once. It runs at the lowest priority, ends with this
/// process, and does nothing if all kernels are already compiled. TYNDALL_PREPARE=0 in the environment disables it.
///
/// The program is a process, not a thread, because a running compilation cannot be stopped and would keep ParaView from
/// quitting.
///
/// Starts the program. To be called when the plugin is loaded.
void StartPreparation();

#endif
