"""Options of the commands that tell of orders: which ones, and at which speeds."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import click

from kurbel.cli.output_options import Numbers

if TYPE_CHECKING:
    _SpeedsType = click.ParamType[tuple[float, ...]]
else:  # before click 8.4 a ParamType has no parameter
    _SpeedsType = click.ParamType

_MOST = 10_000


def _speed(text: str, unit: str) -> float:
    """Return a speed in revolutions per second; unit: of one that has none of its own."""
    from kurbel.declared.units import parse_quantity, written_unit

    return parse_quantity(text if written_unit(text) else f"{text} {unit}".strip(), "speed")


class Speeds(_SpeedsType):
    """Speeds of rotation, with one unit or each with its own: `300, 350 rpm`; or from, to, step: `300:1500:10 rpm`."""

    name = "speeds"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> tuple[float, ...]:
        """Return the speeds in revolutions per second, in the order given."""
        if not isinstance(value, str):
            return tuple(value)
        from kurbel.declared.units import written_unit
        from kurbel.errors import UnitError

        each = value.replace(":", ",").split(",")
        unit = written_unit(each[-1])
        try:
            numbers = [_speed(text, unit) for text in each]
        except UnitError as error:
            self.fail(str(error), param, ctx)
        speeds = self._stepped(numbers, value, param, ctx) if ":" in value else tuple(numbers)
        if not all(speed > 0 for speed in speeds):
            self.fail(f"'{value}': a speed is more than 0", param, ctx)
        return speeds

    def _stepped(self, numbers: list[float], value: str, *place: Any) -> tuple[float, ...]:
        if len(numbers) != 3 or "," in value or not numbers[2] > 0 or numbers[1] < numbers[0]:
            self.fail(f"'{value}': write from, to and step as '300:1500:10 rpm'", *place)
        low, high, step = numbers
        count = (high - low) / step
        if count > _MOST:
            self.fail(f"'{value}': more than {_MOST} speeds; take a larger step", *place)
        return tuple(low + step * index for index in range(int(count + 1e-9) + 1))


orders_option = click.option(
    "--orders",
    type=Numbers(),
    metavar="A,B,...",
    help="Only these orders, periods per turn of the shaft; all up to 24 if not given.",
)
speeds_option = click.option(
    "--speeds", type=Speeds(), metavar="'A,B,... rpm'", help="Also at these speeds; or 'FROM:TO:STEP rpm'."
)
