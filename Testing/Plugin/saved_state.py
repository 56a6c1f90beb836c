"""A state that ParaView saved in a session of its window, for tests that look at it."""
import os
import xml.etree.ElementTree as ElementTree

folder = os.environ["TYNDALL_TEST_OUTPUT"]


def forget(*names):
    for name in names:
        if os.path.exists(os.path.join(folder, name)):
            os.remove(os.path.join(folder, name))


class State:
    def __init__(self, name):
        self.proxies = list(ElementTree.parse(os.path.join(folder, name)).iter("Proxy"))

    def all(self, **attributes):
        return [proxy for proxy in self.proxies if all(proxy.get(key) == value for key, value in attributes.items())]

    def one(self, **attributes):
        found = self.all(**attributes)
        assert len(found) == 1, (attributes, found)
        return found[0]


def values(proxy, name):
    """Numbers, texts or the proxies of a property."""
    prop = next(each for each in proxy.findall("Property") if each.get("name") == name)
    return [each.get("value") for each in prop if each.tag in ("Element", "Proxy")]
