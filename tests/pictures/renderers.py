"""Renders the pictures of a folder, as they stand before they move, with all renderers that there are, and compares what these draw."""

import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image, ImageChops, ImageFilter

# What edges may look like, in pixels; and how far two renderers may be apart behind that blur, of 255.
BLUR = 2
APART = 40
# A picture that is as even as this shows nothing, of 255.
EVEN = 60
# How long one renderer may take (s).
PATIENCE = 100
DARK = "@media (prefers-color-scheme:dark){"


def light(text):
    """The text without its colours for the dark, which some renderers take for all."""
    while (start := text.find(DARK)) >= 0:
        end, depth = start + len(DARK), 1
        while depth:
            depth += {"{": 1, "}": -1}.get(text[end], 0)
            end += 1
        text = text[:start] + text[end:]
    return text


def rsvg(pictures):
    for svg, png in pictures:
        subprocess.run(["rsvg-convert", svg, "-o", png], check=True, timeout=PATIENCE)


def inkscape(pictures):
    lines = [f"file-open:{svg}; export-filename:{png}; export-do; file-close\n" for svg, png in pictures]
    quiet = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
    subprocess.run(["inkscape", "--shell"], input="".join(lines).encode(), check=True, timeout=PATIENCE, **quiet)


def resvg(pictures):
    import resvg_py

    for svg, png in pictures:
        Path(png).write_bytes(bytes(resvg_py.svg_to_bytes(svg_string=Path(svg).read_text())))


def cairosvg(pictures):
    import cairosvg

    for svg, png in pictures:
        cairosvg.svg2png(url=str(svg), write_to=str(png))


def rendered(png):
    image = Image.open(png).convert("RGBA")
    paper = Image.new("RGBA", image.size, "white")
    paper.alpha_composite(image)
    return paper.convert("RGB").filter(ImageFilter.GaussianBlur(BLUR))


def greatest(difference):
    return max(high for _, high in difference.getextrema())


def main():
    sources = sorted(Path(sys.argv[1]).glob("*.svg"))
    with tempfile.TemporaryDirectory() as folder:
        for source in sources:
            (Path(folder) / source.name).write_text(light(source.read_text()))
        drawn = {}
        for render in [rsvg, inkscape, resvg, cairosvg]:
            program = {rsvg: "rsvg-convert", inkscape: "inkscape"}.get(render)
            if program and not shutil.which(program):
                continue
            name = render.__name__
            pictures = [(Path(folder) / source.name, Path(folder) / f"{source.stem}.{name}.png") for source in sources]
            try:
                render(pictures)
                drawn[name] = [rendered(png) for _, png in pictures]
            except (ImportError, OSError, subprocess.SubprocessError) as why:
                # it does not start here, or not without a screen: that is no fault of the pictures
                print(f"{name} draws nothing here: {why!r}")
    if len(drawn) < 2:
        print(f"pictures are not compared: of the renderers there is {' and '.join(drawn) or 'none'}")
        return 0
    (first, wanted), *others = drawn.items()
    worst, faults = 0, []
    for k, source in enumerate(sources):
        low = min(low for low, _ in wanted[k].getextrema())
        if low > 255 - EVEN:
            faults.append(f"{source.name}: {first} draws nothing")
        for name, found in others:
            if found[k].size != wanted[k].size:
                faults.append(f"{source.name}: {first} draws {wanted[k].size}, {name} {found[k].size}")
                continue
            apart = greatest(ImageChops.difference(found[k], wanted[k]))
            worst = max(worst, apart)
            if apart > APART:
                faults.append(f"{source.name}: {first} and {name} are {apart} of 255 apart")
    print("\n".join(faults) or f"{len(sources)} pictures: {', '.join(drawn)} agree within {worst} of 255")
    return 1 if faults or not sources else 0


if __name__ == "__main__":
    sys.exit(main())
