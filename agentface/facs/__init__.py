"""Action units of FACS (Ekman, Friesen, Hager 2002): what each contracts or turns."""
