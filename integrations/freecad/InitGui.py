import FreeCADGui as Gui


class DupinWorkbench(Gui.Workbench):
    MenuText = "Dupin"
    ToolTip = "Shapes drawn from their exact surfaces"

    def Initialize(self):
        import dupin_commands

        dupin_commands.register()
        self.appendToolbar("Dupin", dupin_commands.NAMES)
        self.appendMenu("Dupin", dupin_commands.NAMES)

    def GetClassName(self):
        return "Gui::PythonWorkbench"


Gui.addWorkbench(DupinWorkbench())
