"""What must come out of the extreme cases whose references are numbers: formulas in mpmath's numbers.

None of them is the solver's: energies, free bodies, complex amplitudes and polygons, with the floats of the file.
"""

import mpmath

mp, mpf = mpmath.mp, mpmath.mpf
Formulas = dict[tuple[str, str], mpmath.mpf]


def all_formulas() -> Formulas:
    """Return the reference of each case, by its name and what is requested."""
    return {
        **of_motion(),
        **of_cards(),
        **of_speed(),
        **of_torsion(),
        **of_coupling(),
        **of_rods(),
        **of_balance(),
        **of_delivery(),
        **of_stress(),
        **of_designs(),
    }


def of_motion() -> Formulas:
    crank, lever, sin, cos = mpf(0.1), mpf(0.4), mp.sin(mp.radians(175)), mp.cos(mp.radians(175))
    formulas = {("infinite rod", "motion x@60"): mpf(0.4) / 2}
    for name, frame in (("100.0001", mpf(100.0001 / 1000)), ("300", mpf(0.3)), ("1e12", mpf(1e9))):
        case = f"slotted lever, frame {name} mm"
        across, along = crank * sin, frame + crank * cos
        speed = 2 * mp.pi * crank * lever
        formulas[case, "motion x@175"] = lever * across / mp.hypot(across, along)  # R_l sin θ
        formulas[case, "motion c_work_max"] = speed / (frame + crank)  # v R_l/(e ± r), R 304, 305
        formulas[case, "motion c_return_max"] = speed / (frame - crank)
    return formulas


def bore_area(bore: float) -> mpmath.mpf:
    return mp.pi / 4 * mpf(bore) ** 2


def of_cards() -> Formulas:
    # steam: admission, p V^n from the cut-off on, exhaust
    high, low, cut_off, clearance = mpf(9e5), mpf(0.2e5), mpf(0.3), mpf(0.05)
    exponent = mpf(1.0000000000000002)
    ratio = (cut_off + clearance) / (1 + clearance)
    expansion = high * (cut_off + clearance) * (1 - ratio ** (exponent - 1)) / (exponent - 1)
    stroke = mpf(0.8)
    steam = (high * cut_off + expansion - low) * stroke * bore_area(0.45)

    # a card of 100 001 points: p = 1 + 8 (1 − z)² bar at z = k/100 000, back at 1 bar; trapezia
    count = 100_000
    squares = mpf(
        sum(2 * k * k for k in range(count)) + count * count
    )  # both ends of every trapezium
    fine = 8e5 * squares / (2 * mpf(count) ** 3) * stroke * bore_area(0.45)
    return {
        ("steam, exponent 1 + 2e-16", "forces work"): steam,
        ("card of 1e5 points", "forces work"): fine,
        # p = 5 + 4 sin φ bar with an infinite rod: A R ∮ 4 sin² φ dφ
        ("trace of 1e5 points", "forces work"): 4e5 * mp.pi * mpf(0.4) * bore_area(0.45),
    }


def of_speed() -> Formulas:
    # M = M_m (1 + cos φ/2): with slip s the speed follows it, ω/ω_n − 1 = s (M/M_m − 1), to s² and to s J ω²/M_m
    return {
        ("effort in a block", "flywheel dE"): 100 * mp.pi,
        # δ = ΔE/(J ω²), where δ² no longer shows
        ("J = 1e15 kg m²", "flywheel delta"): 100 * mp.pi / (mpf(1e15) * (2 * mp.pi) ** 2),
        ("load that falls as 1/ω, ∮ dφ/ω as at the nominal speed", "flywheel omega_mean"): 100
        * mp.pi
        / 60,
        ("slip 1e-12", "flywheel delta"): mpf(1e-12),
        ("slip 1e-12", "flywheel omega@0"): 2 * mp.pi * (1 + mpf(1e-12) / 2),
        ("mean torque under waves of 1e12 times it", "harmonics M_mean"): mpf(1),
    }


CHAINS = {
    "J over 1e12, stiff": (1e-6, 1e6, 1e6),
    "J over 1e12, soft": (1e-6, 1e6, 1e-6),
    "J over 1e12, heavy mass first": (1e6, 1e-6, 1e6),
    "J and k equal to 1e-12": (1e-12, 1e-12, 1e-12),
}


def of_torsion() -> Formulas:
    formulas = {}
    for name, (first, second, stiffness) in CHAINS.items():
        square = mpf(stiffness) * (1 / mpf(first) + 1 / mpf(second))
        formulas[name, "torsion natural_frequency"] = mp.sqrt(square) / (2 * mp.pi)
    # T = M J₂/(J₁ + J₂) s/(s − Ω²) with s = ω_e² (1 + iη)
    first, second, amplitude, omega = 3, 5, 500, 2 * mp.pi
    for stiffness, loss in ((74.02203300816073, 1e-6), (74.02203300816073, 1e-9)):
        spring = mpf(stiffness) * (mpf(1) / first + mpf(1) / second) * mp.mpc(1, mpf(loss))
        torque = mpf(amplitude) * second / (first + second) * spring / (spring - omega**2)
        formulas[f"resonance, loss factor {loss:g}", "torsion M_vibratory"] = abs(torque)
    return formulas


STIFFNESSES = {99: 193463977.0, 101: 201360000.0}


def of_coupling() -> Formulas:
    omega, inertia = 2 * mp.pi, mpf(1000)
    orders = {n: mp.sqrt(mpf(k) * 2 / inertia) / omega for n, k in STIFFNESSES.items()}
    square = orders[99] ** 2
    return {
        ("coupling, natural order 99", "flywheel natural_order"): orders[99],
        # half of the wave of 500 N m accelerates the driven mass, magnified by n²/(n² − 1)
        ("coupling, natural order 99", "flywheel M_coupling_max"): 1000
        + 250 * square / (square - 1),
        ("coupling, natural order 101", "flywheel natural_order"): orders[101],
        # a stiff one: what the driven mass, half of all, and the load take
        ("coupling, natural order 101", "flywheel M_coupling_max"): 1000 + mpf(250),
    }


def of_rods() -> Formulas:
    """Torque of a free rod by its kinetic energy, M = −dE/dφ, and the force in a rod hardly longer than the crank."""
    crank, rod, mass, gravity, inertia, omega = (
        *map(mpf, (0.4, 2.0, 100.0, 0.8, 96000.0)),
        2 * mp.pi,
    )

    def energy(phi: mpmath.mpf) -> mpmath.mpf:
        """Kinetic energy of the rod at uniform rotation, from the places of its pins."""

        def centre(at: mpmath.mpf) -> mpmath.mpc:
            pin = crank * mp.expj(at)
            crosshead = pin.real + mp.sqrt(rod**2 - pin.imag**2)
            return crosshead + (pin - crosshead) * gravity / rod

        def angle(at: mpmath.mpf) -> mpmath.mpf:
            return mp.asin(crank * mp.sin(at) / rod)

        speed, turning = mp.diff(centre, phi), mp.diff(angle, phi)
        return omega**2 / 2 * (mass * abs(speed) ** 2 + inertia * turning**2)

    torque = -mp.diff(energy, mp.radians(30))

    # P = −m b along the stroke; the rod carries P/cos ψ
    length = mpf(0.4 * 1.0000001)
    phi = mp.radians(mpf(89.9))

    def displacement(at: mpmath.mpf) -> mpmath.mpf:
        return -crank * mp.cos(at) - mp.sqrt(length**2 - (crank * mp.sin(at)) ** 2)

    acceleration = mp.diff(displacement, phi, 2) * omega**2
    along = mp.sqrt(1 - (crank * mp.sin(phi) / length) ** 2)
    return {
        ("exact rod of a thousandfold inertia", "forces M@30"): torque,
        ("bearing of a rod, L/R = 1.0000001", "bearings load@89.9"): abs(
            100 * acceleration / along
        ),
    }


def of_balance() -> Formulas:
    # a long rod is shaken most at the inner dead centre, m R ω² (1 + λ); one hardly longer than the crank near 90°
    crank, omega = mpf(0.4), 2 * mp.pi
    formulas = {
        ("100 cylinders in phase", "balance F_free_max"): 10_000
        * crank
        * omega**2
        * (1 + mpf(1) / 5)
    }
    for ratio in (1.0001, 1.0000001):
        length = mpf(0.4 * ratio)  # rounded; 1 u of it is 2500 u, and 2.5e6 u, of the force

        def slowing(phi: mpmath.mpf, length: mpmath.mpf = length) -> mpmath.mpf:
            """Return −d²x/dφ² of x = R (1 − cos φ) + L − √(L² − R² sin² φ)."""
            sin, cos = mp.sin(phi), mp.cos(phi)
            height = mp.sqrt(length**2 - (crank * sin) ** 2)
            of_rod = crank**2 * (cos**2 - sin**2) / height + crank**4 * (sin * cos) ** 2 / height**3
            return -(crank * cos + of_rod)

        begin = mp.pi / 2
        top = mp.findroot(lambda phi, force=slowing: mp.diff(force, phi), (begin, begin + 1e-9))
        name = (f"L/R = {ratio:.8g}", "balance F_free_max")
        formulas[name] = 100 * omega**2 * slowing(top)
    return formulas


def of_delivery() -> Formulas:
    # η_v = 1 + c − c p₂/p₁ of isothermal expansion
    clearance, ratio = mpf(0.1), mpf(1099999.9) / mpf(100000.0)
    efficiency = 1 + clearance - clearance * ratio

    # ΔV: the flow of a plunger, A R ω sin φ on one stroke, above its mean
    area, crank = bore_area(0.1), mpf(0.1)
    above = mp.asin(1 / mp.pi)
    fluctuation = area * crank * (2 * mp.cos(above) - (mp.pi - 2 * above) / mp.pi)
    volume = mpf(VESSEL)
    return {
        ("η_v = 1e-7", "delivery volumetric_efficiency"): efficiency,
        ("vessel of ΔV/2 (1 + 1e-7)", "delivery volume_fluctuation"): fluctuation,
        ("vessel of ΔV/2 (1 + 1e-7)", "delivery vessel_swing"): fluctuation / volume,
    }


VESSEL = 0.000432834515


def of_stress() -> Formulas:
    # bending of the pin by the dead-centre force on two bearings, P a b/(a + b) over π d³/32
    force, first, second, diameter = mpf(5e5) * bore_area(0.45), mpf(1e5), mpf(0.3), mpf(0.1)
    bending = force * first * second / (first + second) / (mp.pi * diameter**3 / 32)
    return {("bearings 100 km apart", "stress sigma_pin_dc"): bending}


def of_designs() -> Formulas:
    work = -mpf(5e5) * bore_area(0.45) * mpf(0.8)
    delta = 100 * mp.pi / (mpf(1e15) * (2 * mp.pi) ** 2)
    return {
        ("solution at the end of the range", "find crank=300 mm:400 mm | stroke = 800 mm"): mpf(
            0.4
        ),
        (
            "rows that stall in between",
            "sweep flywheel.inertia=1e15 kg m2,1 kg m2,1e15 kg m2 | delta[2]",
        ): delta,
        ("rows that lock in between", "sweep friction.crosshead=0,20,0 | work[2]"): work,
    }
