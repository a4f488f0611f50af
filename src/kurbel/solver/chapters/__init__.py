"""What stands on the turning effort and on the cylinders, one chapter a file; `kurbel.solver.case` opens them."""
