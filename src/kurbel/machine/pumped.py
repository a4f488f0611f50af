"""What pumps and compressors move: the gas of a compressor, and liquid, pipes and air vessels of a pump."""

from collections.abc import Iterator

from kurbel.declared.record import Record, Rule, alternative, field

GAS_CONSTANT = 8.31446261815324
"""J/(mol K)."""
WATER = 1000.0, 2339.0
"""Density in kg/m³ of water, and its vapour pressure in Pa at 20 °C."""


class Gas(Record):
    """The gas that a compressor draws in, as an ideal one; what is None is left out, or as in the whole machine."""

    inlet_temperature: float = field(
        "temperature",
        "Temperature of the gas where it is drawn in",
        "T_1",
        above=0,
        example="20 °C",
    )
    gas_constant: float | None = field(
        "gas_constant",
        "Specific gas constant; or give `molar_mass`",
        "R",
        above=0,
        absent="that of the machine's `gas`, else mass flows left out",
        example="287 J/(kg K)",
    )
    _molar_mass = alternative(
        "molar_mass",
        "Molar mass, which gives the gas constant",
        "M",
        above=0,
        instead="gas_constant",
        gives=lambda values: {"gas_constant": GAS_CONSTANT / values["molar_mass"]},
    )
    isentropic_exponent: float | None = field(
        "ratio",
        "Exponent of the compression without heat, c_p/c_v",
        "κ",
        above=1,
        most=10,
        absent="that of the machine's `gas`, else isentropic power left out",
        example="1.4",
    )

    @property
    def mass_of_mole(self) -> float | None:
        """Its molar mass in kg/mol."""
        if self.gas_constant is None:
            return None
        return GAS_CONSTANT / self.gas_constant


class Liquid(Record):
    """What a pump moves."""

    density: float = field(
        "density", "Density", "ρ", default=WATER[0], above=0, absent="1000 kg/m³, water"
    )
    vapour_pressure: float = field(
        "pressure",
        "Absolute pressure at which the liquid boils",
        default=WATER[1],
        least=0,
        absent="23.4 mbar, water at 20 °C",
    )


class Vessel(Record):
    """An air vessel; its volume of air, or the swing of pressure for which its volume is wanted."""

    volume: float | None = field("volume", "Mean volume of its air", "V", above=0, example="20 l")
    pressure_swing: float | None = field(
        "ratio",
        "Wanted swing of its absolute pressure, (p_max − p_min)/p_mean",
        "δ",
        above=0,
        below=2,
        instead="volume",
        example="5 %",
    )
    exponent: float = field(
        "ratio",
        "Exponent of p V^n of its air",
        "n",
        default=1.0,
        least=0.5,
        most=2,
        absent="1, isothermal",
        example="1.2",
    )

    def rules(self) -> Iterator[Rule]:
        is_empty = self.volume is None and self.pressure_swing is None
        message = "give the 'volume' of the vessel, or the 'pressure_swing' that it may have"
        yield Rule((), is_empty, message)


class Pipe(Record):
    """A pipe with all chambers of the pump on it."""

    length: float = field("length", "Length of the pipe", "l", above=0, example="12 m")
    diameter: float = field("length", "Bore of the pipe", "d", above=0, example="100 mm")
    lift: float | None = field(
        "length", "Height that the pipe lifts the liquid", "h", least=0, absent="not compared"
    )
    friction_factor: float = field(
        "ratio",
        "Friction factor of the pipe (Darcy)",
        "f",
        default=0.0,
        least=0,
        most=1,
        absent="0, no friction",
        example="0.03",
    )
    vessel: Vessel | None = field(Vessel, "Air vessel between pipe and pump", absent="none")


class Pump(Record):
    """What a pump's flow depends on besides its pistons."""

    slip: float = field(
        "ratio",
        "Share of the displaced volume that is not delivered",
        default=0.0,
        least=0,
        below=1,
        example="0.03",
    )
    liquid: Liquid = field(Liquid, "What is pumped", default=Liquid(), absent="water")
    suction_pipe: Pipe | None = field(Pipe, "Pipe to the pump", absent="suction lift left out")
    delivery_pipe: Pipe | None = field(Pipe, "Pipe from the pump", absent="left out")
