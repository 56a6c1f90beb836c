"""The whole chain in pvbatch: light that its medium and its lights allow, and a picture of it."""
import os
import sys

sys.path.insert(0, os.path.dirname(os.path.abspath(__file__)))
import whole_chain

sky = os.path.join(os.environ["TYNDALL_TEST_OUTPUT"], "ChainInBatch.hdr")
whole_chain.write_sky(sky)
found = whole_chain.values(*whole_chain.solve_and_render(sky))
assert found["fluence"].min() > 0 and found["radiance"].max() > 0
assert found["rows"] == found["orders"] > 3, found
entered, emitted, absorbed, escaped, left = found["balance"]
assert (entered > 0).all() and (abs(entered + emitted - absorbed - escaped - left) < 1e-5 * entered).all()
