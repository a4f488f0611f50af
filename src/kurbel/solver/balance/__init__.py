"""What the moving parts do to the frame: free forces and moments, and the weights that take them away.

A free force is minus the sum of mass times acceleration of all moving parts (d'Alembert), at uniform rotation. It is a
complex number in the plane square to the shaft: real along the stroke line of cylinder 1, outward from the shaft,
imaginary 90° on in the sense of rotation. Angles count in that sense, from there.

    γ, β     bank angle of a cylinder, and by how much its crank follows crank 1: its throw stands at φ + γ − β
    F_j      (m b(φ − β) + m_rot R ω² e^{i(φ − β)}) e^{iγ}, b toward the shaft as everywhere
    u        mass times radius of a weight with its direction at φ = 0; turning n times it pulls with u n² ω² e^{±inφ}
    M        Σ (z − z_0) F, the vector of the moment turned back by 90°, so that it stands as the forces do
    f, g     F = Σ f_n e^{inφ} + g_n e^{−inφ}: circles of order n with the rotation and against it
"""
