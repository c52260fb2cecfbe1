#!/usr/bin/python3
"""test_qp.py: quadratic programs, beside what is known of their solutions."""

import sys
import unittest

import numpy
import scipy.sparse
import scipy.sparse.linalg

import epafi


def string(n):
    """A string of n inner nodes, times h squared, and its weight."""
    return scipy.sparse.diags([-1, 2, -1], [-1, 0, 1], shape=(n, n)), numpy.full(n, -1 / (n + 1) ** 2)


class Programs(unittest.TestCase):
    def test_a_string_lies_on_its_floor_as_the_closed_form_has_it(self):
        a, b = string(399)
        result = epafi.solve_qp(a, b, lower=-0.1, tolerance=1e-10)
        self.assertAlmostEqual(result.bound_multiplier.sum() * 400, 1 - 2 * numpy.sqrt(0.2), delta=1e-2)
        self.assertTrue((result.x >= -0.1).all())
        numpy.testing.assert_allclose(a @ result.x - b, result.bound_multiplier, atol=1e-11)
        self.assertLess(max(result.kkt.values()), 1e-9)

    def test_matrices_arrays_operators_and_functions_are_the_same(self):
        a, b = string(30)
        forms = (a, a.toarray(), scipy.sparse.linalg.aslinearoperator(a), lambda x: a @ x)
        first, *others = (epafi.solve_qp(form, b, lower=-0.1, tolerance=1e-12).x for form in forms)
        for x in others:
            numpy.testing.assert_allclose(x, first, atol=1e-12)

    def test_an_inverse_as_preconditioner_takes_few_products(self):
        a, b = string(300)
        inverse = scipy.sparse.linalg.splu(a.tocsc())
        m = scipy.sparse.linalg.LinearOperator(a.shape, matvec=inverse.solve)
        plain = epafi.solve_qp(a, b, upper=1, tolerance=1e-8)
        preconditioned = epafi.solve_qp(a, b, upper=1, preconditioner=m, tolerance=1e-8)
        self.assertLess(5 * preconditioned.products, plain.products)
        numpy.testing.assert_allclose(preconditioned.x, plain.x, atol=1e-6)

    def test_discs_hold_pairs_of_entries(self):
        result = epafi.solve_qp(numpy.eye(4), [3, 4, 0.5, 9], upper=[9, 9, 9, 2], discs=([[0, 1]], [1]), tolerance=1e-10)
        numpy.testing.assert_allclose(result.x, [0.6, 0.8, 0.5, 2], atol=1e-9)
        moved = epafi.solve_qp(numpy.eye(2), [3, 4], discs=([[0, 1]], [1], [[3, 2]]), tolerance=1e-10)
        numpy.testing.assert_allclose(moved.x, [3, 3], atol=1e-9)

    def test_the_default_takes_active_sets_on_discs_and_mprgp_within_bounds(self):
        a, b = string(40)
        discs = numpy.arange(40).reshape(-1, 2), numpy.full(20, 0.1)
        products = {(name, on_discs): epafi.solve_qp(a, 16 * b, tolerance=1e-8, parameters={"Algorithm": name}, **(
            {"discs": discs} if on_discs else {"lower": -0.1})).products
            for name in ("auto", "MPRGP", "active set") for on_discs in (False, True)}
        self.assertEqual(products["auto", False], products["MPRGP", False])
        self.assertEqual(products["auto", True], products["active set", True])
        self.assertLess(products["active set", True], products["MPRGP", True])

    def test_equations_hold_and_have_multipliers(self):
        result = epafi.solve_qp(numpy.eye(3), [1, 2, 3], equalities=([[1, 1, 1]], [3]), tolerance=1e-10)
        numpy.testing.assert_allclose(result.x, [0, 1, 2], atol=1e-9)
        numpy.testing.assert_allclose(result.equality_multiplier, [1], atol=1e-8)

    def test_what_has_no_solution_or_does_not_fit_is_refused(self):
        with self.assertRaisesRegex(epafi.SolvabilityError, "Infeasible"):
            epafi.solve_qp(numpy.eye(2), [1, 1], upper=0, equalities=([[1, 1]], [3]))
        with self.assertRaisesRegex(epafi.SolvabilityError, "Unbounded"):
            epafi.solve_qp(numpy.zeros((2, 2)), [1, 1], lower=0)
        nan = numpy.nan
        for wrong in (dict(lower=[1, 2, 3]), dict(start=[1]), dict(discs=([[0, 5]], [1])), dict(parameters={"Tolerence": 1}),
                      dict(preconditioner=numpy.eye(3)), dict(lower=[0, nan]), dict(upper=nan), dict(start=[0, nan]),
                      dict(discs=([[0, 1]], [nan])), dict(discs=([[0, 1]], [1], [[nan, 0]])), dict(equalities=([[1, nan]], [0])),
                      dict(equalities=([[1, 1]], [nan])), dict(preconditioner=[[1, 0], [0, nan]])):
            with self.subTest(wrong), self.assertRaises(ValueError):
                epafi.solve_qp(numpy.eye(2), [1, 1], **wrong)
        for hessian, what in ((numpy.triu(string(5)[0].toarray()), "not symmetric"), (scipy.sparse.tril(string(5)[0]), "not symmetric"),
                              (1j * numpy.eye(5), "complex"), (scipy.sparse.linalg.aslinearoperator(1j * numpy.eye(5)), "complex")):
            for matrices in ((hessian,), (numpy.eye(5), hessian)):
                with self.subTest(what), self.assertRaisesRegex(epafi.InputError, what):
                    epafi.solve_qp(matrices[0], string(5)[1], preconditioner=matrices[-1] if len(matrices) > 1 else None)
        with self.assertRaisesRegex(epafi.InputError, "complex"):
            epafi.solve_qp(numpy.eye(2), [1, 1j])
        for hessian, linear_term in (([[1, nan], [nan, 1]], [1, 1]), (numpy.eye(2), [1, nan])):
            with self.assertRaisesRegex(epafi.InputError, "entry .* is nan"):
                epafi.solve_qp(hessian, linear_term)
        with self.assertRaises(epafi.NotConverged) as caught:
            epafi.solve_qp(*string(200), lower=-0.1, parameters={"MPRGP": {"Maximum Multiplications": 5}})
        self.assertEqual(caught.exception.result.status, "MaxIterations")

    def test_what_an_operator_raises_comes_through(self):
        def refuse(_):
            raise RuntimeError("enough")
        with self.assertRaisesRegex(RuntimeError, "enough"):
            epafi.solve_qp(refuse, [1, 1])
        with self.assertRaisesRegex(epafi.InputError, "has 3 entries"):
            epafi.solve_qp(lambda x: numpy.ones(3), [1, 1])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
