"""Writes `notebook.ipynb`; run it to make the notebook anew, without outputs."""

from pathlib import Path

import nbformat
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

CELLS = [
    new_markdown_cell("# A slider-crank in a notebook\n\nThe mechanism shows itself; then its motion, a plot, and a sweep."),
    new_code_cell('import mechc\n\nm = mechc.load("examples/slider_crank.mech")\nm'),
    new_code_cell('run = m.run(every="0.5 ms")\nrun.plot("travel", "travel.dd");'),
    new_code_cell(
        'sweep = m.sweep(\n    vary={"rod_length": mechc.between("120 mm", "200 mm", 30)},\n'
        '    results={"peak": "max(abs(der(der(travel))))"},\n)\nframe = sweep.to_polars()\nframe.sort("peak").head(3)'
    ),
    new_code_cell('m.jacobian(by=["rod_length"], results={"peak": "max(abs(der(der(travel))))"}).results'),
]

if __name__ == "__main__":
    notebook = new_notebook(cells=CELLS, metadata={"kernelspec": {"name": "python3", "display_name": "Python 3", "language": "python"}})
    for number, cell in enumerate(notebook.cells):
        cell.id = f"cell-{number}"
    nbformat.write(notebook, Path(__file__).with_name("notebook.ipynb"))
