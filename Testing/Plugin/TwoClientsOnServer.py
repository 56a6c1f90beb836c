"""Two clients at once on a server with --multi-clients: both use the plugin, and get the same light.

ParaView loads a plugin into a server once. A client that asks for it again, with LoadPlugin(..., remote=True), is
told "Plugin load failed: No plugin loaded yet.", whatever the plugin: vtkPVPluginLoader returns early for a file that
the process has, and leaves its flag Loaded as it was. The server has it all the same, and so has the client after it
has loaded the plugin for itself with remote=False. On a server that is started with the plugin (PV_PLUGIN_PATH, and
--plugins) no client needs remote=True.

    python3 TwoClientsOnServer.py
    pvpython TwoClientsOnServer.py PORT NAME    a client, which waits for a line before it goes
"""
import os
import subprocess
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))

import a_server

plugin = os.environ["TYNDALL_PLUGIN"]


def be_client(port, name):
    from paraview import servermanager
    from paraview.simple import Connect, LoadPlugin, Wavelet

    Connect("localhost", port)
    plugins = servermanager.vtkSMProxyManager.GetProxyManager().GetPluginManager()
    remote = plugins.GetRemoteInformation(servermanager.ActiveConnection.Session)
    loaded = any(remote.GetPluginName(i) == "Tyndall" and remote.GetPluginLoaded(i)
                 for i in range(remote.GetNumberOfPlugins()))
    if not loaded:
        LoadPlugin(plugin, remote=True, ns=globals())
    LoadPlugin(plugin, remote=False, ns=globals())
    waves = Wavelet(WholeExtent=[0, 4, 0, 4, 0, 4])
    medium = ParticipatingMedium(Input=waves, ExtinctionScale=0.3)
    light = LightPropagationMaps(Input=medium, SkyColor=[1, 1, 1])
    light.UpdatePipeline()
    fluence = light.CellData["fluence"].GetRange()
    print("%s: the server %s the plugin, fluence %r" % (name, "has" if loaded else "had not", fluence), flush=True)
    sys.stdin.readline()


def light_of_two(environment, options, first_word):
    port = a_server.free_port()
    server = subprocess.Popen(["pvserver", "--multi-clients", "--server-port=%d" % port, *options],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                              env={**os.environ, **environment})
    clients = []
    try:
        assert any("Accepting connection" in line for line in server.stdout), "the server does not start"
        said = []
        for name, word in (("one", first_word), ("two", "has")):
            client = subprocess.Popen(["pvpython", os.path.abspath(__file__), str(port), name], stdin=subprocess.PIPE,
                                      stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
            clients.append(client)  # it stays
            lines = []
            for line in client.stdout:
                lines.append(line)
                if line.startswith(name + ":"):
                    break
            assert lines and lines[-1].startswith("%s: the server %s the plugin" % (name, word)), "".join(lines)
            said.append(lines[-1].split("fluence")[1])
        assert said[0] == said[1] and "(0.0, 0.0)" not in said[0], said
        for client in clients:
            rest, _ = client.communicate("go\n")
            assert client.returncode == 0, rest
    finally:
        for process in clients + [server]:
            process.kill()


if len(sys.argv) > 1:
    be_client(int(sys.argv[1]), sys.argv[2])
else:
    light_of_two({}, [], "had not")
    light_of_two({"PV_PLUGIN_PATH": os.path.dirname(plugin)}, ["--plugins=Tyndall"], "has")
