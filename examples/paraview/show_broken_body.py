"""Two views of a broken body: its surface coloured by fragment, its springs by stretch. Run it with ParaView's Python:

    crumble export experiment.crec --at 5.3 --out surface.vtu
    crumble export experiment.crec --at 5.3 --what springs --out springs.vtu
    pvbatch show_broken_body.py surface.vtu springs.vtu picture.png

In the window of ParaView the same takes a few clicks: see docs/export.md.
"""

import sys

from paraview.simple import *

surface_file, springs_file, picture = sys.argv[1:]

surface = XMLUnstructuredGridReader(FileName=[surface_file])
shaded = GenerateSurfaceNormals(Input=ExtractSurface(Input=surface), FeatureAngle=30)

springs = XMLUnstructuredGridReader(FileName=[springs_file])
whole = Threshold(Input=springs, Scalars=["CELLS", "intact"], LowerThreshold=1, UpperThreshold=1)
tubes = Tube(Input=ExtractSurface(Input=whole), Radius=0.00025)


def make_view(source, array):
    view = CreateRenderView(UseColorPaletteForBackground=0, Background=[0.82, 0.85, 0.88])
    view.OrientationAxesVisibility = 0
    display = Show(source, view)
    ColorBy(display, ("CELLS", array))
    view.CameraPosition, view.CameraFocalPoint, view.CameraViewUp = [-0.06, 0.075, 0.11], [-0.009, 0.019, 0], [0, 1, 0]
    view.CameraViewAngle = 31
    return view, display


def show_scale(view, display, title):
    display.SetScalarBarVisibility(view, True)
    bar = GetScalarBar(GetColorTransferFunction(display.ColorArrayName[1]), view)
    bar.Title, bar.ComponentTitle = title, ""
    bar.TitleColor = bar.LabelColor = [0, 0, 0]
    bar.TitleFontSize, bar.LabelFontSize = 18, 14
    bar.AutomaticLabelFormat, bar.LabelFormat, bar.RangeLabelFormat = 0, "%.2f", "%.2f"
    bar.WindowLocation, bar.Position, bar.ScalarBarLength = "Any Location", [0.86, 0.05], 0.55


left, by_fragment = make_view(shaded, "fragment")
shaded.UpdatePipeline()
last = int(surface.CellData["fragment"].GetRange()[1])
colours = GetColorTransferFunction("fragment")
colours.InterpretValuesAsCategories = 1
colours.ApplyPreset("KAAMS", True)
colours.Annotations = [text for fragment in range(last + 1) for text in (str(fragment), str(fragment))]
show_scale(left, by_fragment, "fragment")

right, by_stretch = make_view(tubes, "stretch")
colours = GetColorTransferFunction("stretch")
colours.ApplyPreset("Cool to Warm (Extended)", True)
colours.RescaleTransferFunction(0.9, 1.1)
show_scale(right, by_stretch, "length / rest length")

layout = CreateLayout()
layout.SplitHorizontal(0, 0.5)
layout.AssignView(1, left)
layout.AssignView(2, right)
layout.SetSize(1200, 560)
SaveScreenshot(picture, layout, ImageResolution=[1200, 560])
