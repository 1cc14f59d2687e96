"""The module as it is installed."""

import pathlib
import unittest

import numpy as np
import voidage

FIXTURES = pathlib.Path(__file__).resolve().parents[3] / "tests/fixtures"
LINE = np.linspace(0.0, 1.0, 5)


def tetrahedron(size=1.0):
    corners = size * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=float)
    return corners[[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]]


class Porosity(unittest.TestCase):
    def test_triangles_in_memory(self):
        found = voidage.porosity(tetrahedron(), (LINE, LINE, LINE), bounds=True)
        self.assertAlmostEqual(found["solid_volume"], 1 / 6, delta=1e-14)
        self.assertEqual(found["beta_v"].shape, (4, 4, 4))
        self.assertEqual(found["beta_x"].shape, (5, 4, 4))
        self.assertEqual(found["beta_z"].shape, (4, 4, 5))
        self.assertTrue(found["beta_v"].flags.f_contiguous)
        self.assertAlmostEqual((1 - found["beta_v"]).sum() / 64, 1 / 6, delta=1e-14)
        self.assertTrue((found["beta_v_lower"] <= found["beta_v"]).all() and (found["beta_v"] <= found["beta_v_upper"]).all())
        self.assertEqual(sum(found["cells"][k] for k in ("open", "cut", "closed")), 64)

    def test_twice_the_same_body_counts_once(self):
        found = voidage.porosity([tetrahedron(), tetrahedron()], (LINE, LINE, LINE), areas=False)
        self.assertAlmostEqual(found["solid_volume"], 1 / 6, delta=1e-9)
        self.assertNotIn("beta_x", found)

    def test_files_and_scale(self):
        edges = np.linspace(-1000.0, 9000.0, 11)
        found = voidage.porosity(FIXTURES / "analytic_boxes_aligned.stl", (edges / 1000,) * 3, scale=0.001)
        small = voidage.porosity(str(FIXTURES / "analytic_boxes_aligned.stl"), (edges,) * 3)
        self.assertGreater(small["solid_volume"], 0)
        # Corners of a binary file that miss a plane of the grid by its rounding lie in it: half a unit in the last place of float32.
        self.assertAlmostEqual(found["solid_volume"] * 1e9 / small["solid_volume"], 1, delta=2**-23)

    def test_what_is_wrong_is_told(self):
        with self.assertRaisesRegex(OSError, "nowhere.stl"):
            voidage.porosity("nowhere.stl", (LINE, LINE, LINE))
        with self.assertRaisesRegex(ValueError, "triangle 2"):
            bad = tetrahedron()
            bad[2, 1, 0] = np.nan
            voidage.porosity(bad, (LINE, LINE, LINE))
        with self.assertRaisesRegex(ValueError, r"\(n, 3, 3\)"):
            voidage.porosity(np.zeros((2, 3, 2)), (LINE, LINE, LINE))
        with self.assertRaisesRegex(ValueError, "edge"):
            voidage.porosity(tetrahedron(), (LINE, LINE[::-1], LINE))
        with self.assertRaises(TypeError):
            voidage.porosity([3], (LINE, LINE, LINE))


class Tolerance(unittest.TestCase):
    def test_is_a_number_from_0_on(self):
        for tol in (-1.0, float("nan"), float("inf")):
            with self.assertRaisesRegex(ValueError, "tol"):
                voidage.porosity(tetrahedron(), (LINE, LINE, LINE), tol=tol)


class Bodies(unittest.TestCase):
    def test_meets(self):
        cube = voidage.Body.box((0, 0, 0), (1, 1, 1))
        self.assertEqual(voidage.meets(cube, voidage.Body.box((1, 0, 0), (2, 1, 1))), "touching")
        self.assertEqual(voidage.meets(cube, voidage.Body.sphere((2, 0.5, 0.5), 0.9)), "apart")
        self.assertEqual(voidage.meets(cube, voidage.Body.sphere((2, 0.5, 0.5), 0.9).rounded(0.2)), "overlapping")

    def test_distance(self):
        hull = voidage.Body.hull([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)])
        found = voidage.distance(hull, voidage.Body.cylinder((3, 0, -1), (3, 0, 1), 0.5))
        self.assertEqual(found.contact, "apart")
        self.assertAlmostEqual(found.distance, 1.5, delta=1e-12)
        self.assertTrue(found.lower <= 1.5 <= found.upper)
        self.assertAlmostEqual(found.a[0], 1.0, delta=1e-6)

    def test_what_is_wrong_is_told(self):
        with self.assertRaisesRegex(ValueError, "body, entry 1"):
            voidage.meets(voidage.Body.point((0, 0, 0)), voidage.Body.sphere((0, 0, 0), -1))

    def test_points_have_three_coordinates(self):
        for wrong in (
            lambda: voidage.Body.sphere((3, 0), 1),
            lambda: voidage.Body.sphere((3, 0, 0, 0.5), 1),
            lambda: voidage.Body.segment((1, 2), (3, 4)),
            lambda: voidage.Body.triangle((0, 0), (1, 0), (0, 1)),
            lambda: voidage.Body.point((1,)),
            lambda: voidage.Body.hull([(0, 0), (1, 0)]),
            lambda: voidage.Body.oriented_box((0, 0, 0), [(1, 0), (0, 1), (0, 0)]),
            lambda: voidage.Body.ellipsoid((0, 0, 0), [(1, 0, 0), (0, 1, 0)]),
        ):
            with self.assertRaisesRegex(ValueError, "three"):
                wrong()

    def test_rounded_twice(self):
        body = voidage.Body.point((0, 0, 0)).rounded(0.5).rounded(0.25)
        self.assertAlmostEqual(voidage.distance(body, voidage.Body.point((2, 0, 0))).distance, 1.25, delta=1e-14)
        with self.assertRaises(ValueError):
            body.rounded(-0.25)


class Flow(unittest.TestCase):
    def test_sod(self):
        x = np.linspace(0, 1, 401)
        flow = voidage.Flow((x, [0, 1], [0, 1]))
        left = (x[:-1] < 0.5).reshape(-1, 1, 1)
        flow.set(rho=np.where(left, 1.0, 0.125), p=np.where(left, 1.0, 0.1))
        before = flow.totals()
        done = flow.advance(0.2)
        self.assertEqual(done.time, 0.2)
        self.assertAlmostEqual(flow.totals()[0], before[0], delta=1e-13)
        state = flow.state()
        # Behind the contact and ahead of it; E. F. Toro, table 4.3.
        self.assertAlmostEqual(state["p"][240, 0, 0], 0.30313, delta=1e-3)
        self.assertAlmostEqual(state["u"][240, 0, 0], 0.92745, delta=1e-3)
        self.assertAlmostEqual(state["rho"][240, 0, 0], 0.42632, delta=2e-3)

    def test_porous(self):
        beta = voidage.porosity(tetrahedron(0.5), (LINE, LINE, LINE))
        flow = voidage.Flow((LINE, LINE, LINE), beta=beta, boundary={"x_min": {"type": "inlet", "rho": 1, "u": (0.1, 0, 0), "p": 1},
                                                                     "x_max": {"type": "outlet", "p": 1}})
        flow.set(rho=1.0, u=0.0, p=1.0)
        done = flow.advance(1.0, max_steps=7)
        self.assertEqual(done.steps, 7)
        self.assertGreater(done.inflow[0][0], 0)
        flow.set_side("x_max", type="wall")
        self.assertTrue(np.isfinite(flow.state()["p"]).all())

    def test_words_of_cases(self):
        x = np.linspace(0, 1, 41)

        def density(**scheme):
            flow = voidage.Flow((x, [0, 1], [0, 1]), **scheme)
            flow.set(rho=np.where(x[:-1] < 0.5, 1.0, 0.125).reshape(-1, 1, 1), p=1.0, u=0.5)
            flow.advance(0.05)
            return flow.state()["rho"]

        for word, own in [("mc", "monotonized-central"), ("none", "unlimited")]:
            self.assertTrue((density(limiter=word) == density(limiter=own)).all())
        # Along one axis they are the same solver.
        self.assertTrue((density(riemann="hllc-low-mach") == density(riemann="hllc")).all())
        with self.assertRaisesRegex(ValueError, "limiter is one of"):
            voidage.Flow((x, [0, 1], [0, 1]), limiter="superbee")

    def test_what_is_wrong_is_told(self):
        with self.assertRaisesRegex(ValueError, "case.gamma"):
            voidage.Flow((LINE, LINE, LINE), gamma=0.9)
        with self.assertRaisesRegex(ValueError, "no side is called 'left'"):
            voidage.Flow((LINE, LINE, LINE), boundary={"left": {}})
        with self.assertRaisesRegex(ValueError, "one of wall"):
            voidage.Flow((LINE, LINE, LINE), boundary={"x_min": {"type": "door"}})
        flow = voidage.Flow((LINE, LINE, LINE))
        with self.assertRaisesRegex(ValueError, "rho, entry 0"):
            flow.set(rho=-1.0, p=1.0)
        with self.assertRaisesRegex(ValueError, "not positive"):
            flow.step(0.1)
        with self.assertRaisesRegex(ValueError, "shape"):
            voidage.Flow((LINE, LINE, LINE), beta=dict.fromkeys(["beta_v", "beta_x", "beta_y", "beta_z"], np.ones((4, 4, 3))))


if __name__ == "__main__":
    unittest.main()
