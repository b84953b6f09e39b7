; Outline for a printer without extrusion: travels, walls, a pause in
; milliseconds. Read it with the built-in machine "printer".
G21
G90
G0 F9000 X20 Y20 Z0.2
G1 F1800 X180
G1 Y180
G1 X20
G1 Y20
G4 P500
G0 F9000 X100 Y100
G2 X100 Y100 I20 J0 F2400
G0 Z10
G0 X0 Y0
