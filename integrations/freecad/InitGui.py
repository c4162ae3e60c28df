import FreeCADGui as Gui


class DupinWorkbench(Gui.Workbench):
    MenuText = "Dupin"
    ToolTip = "Shapes drawn from their exact surfaces"

    def Initialize(self):
        import dupin_commands
        import dupin_view  # noqa: F401: takes a while, better now than with the first command

        dupin_commands.register()
        self.appendToolbar("Dupin", dupin_commands.NAMES)
        self.appendMenu("Dupin", dupin_commands.NAMES)

    def GetClassName(self):
        return "Gui::PythonWorkbench"


Gui.addWorkbench(DupinWorkbench())
