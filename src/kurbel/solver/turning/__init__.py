"""The whole machine on its shaft: turning effort, excess work, flywheel, coupling, speed line."""
