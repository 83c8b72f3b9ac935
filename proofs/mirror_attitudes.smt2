; Attitudes of the paper's four axes (eq 16) at which a fault on one sensor hides from triples, exactly. Fault on sensor 1 (2
; and 3 follow by turning 120 degrees about z); a triple passes if the length of its estimate is that of g. Each point
; below stands, with the same coordinates, in tests/detection/mirror_attitudes_test.cpp, where the code is held against it.
(set-logic QF_NRA)
(declare-const r2 Real)
(declare-const r6 Real)
(assert (and (> r2 0) (= (* r2 r2) 2.0) (> r6 0) (= (* r6 r6) 6.0)))
(declare-const x Real)
(declare-const y Real)
(declare-const z Real)
(declare-const f Real)
(assert (= (+ (* x x) (* y y) (* z z)) 1.0))
(define-fun along1 ((a Real) (b Real) (c Real)) Real (+ (* (/ 2.0 3.0) r2 a) (* (/ 1.0 3.0) c)))
(define-fun along2 ((a Real) (b Real) (c Real)) Real (+ (* (- (/ 1.0 3.0)) r2 a) (* (/ 1.0 3.0) r6 b) (* (/ 1.0 3.0) c)))
(define-fun along3 ((a Real) (b Real) (c Real)) Real (+ (* (- (/ 1.0 3.0)) r2 a) (* (- (/ 1.0 3.0)) r6 b) (* (/ 1.0 3.0) c)))
; What the fault moves the estimate of each triple by, per unit: w124, w134, w123.
(define-fun w124x () Real (* (/ 3.0 4.0) r2))
(define-fun w124y () Real (* (/ 1.0 4.0) r6))
(define-fun w134y () Real (* (- (/ 1.0 4.0)) r6))
(define-fun w123x () Real (* (/ 1.0 2.0) r2))
(define-fun square ((a Real) (b Real) (c Real)) Real (+ (* a a) (* b b) (* c c)))
(define-fun pass124 () Bool (= (square (+ x (* f w124x)) (+ y (* f w124y)) z) 1.0))
(define-fun pass134 () Bool (= (square (+ x (* f w124x)) (+ y (* f w134y)) z) 1.0))
(define-fun pass123 () Bool (= (square (+ x (* f w123x)) y (+ z f)) 1.0))

; They are what they are said to be: 1 along the faulty axis, 0 along the two others of the triple.
; expect: unsat
(push)
(assert (not (and (= (along1 w124x w124y 0.0) 1.0) (= (along2 w124x w124y 0.0) 0.0)
                  (= (along1 w124x w134y 0.0) 1.0) (= (along3 w124x w134y 0.0) 0.0)
                  (= (along1 w123x 0.0 1.0) 1.0) (= (along2 w123x 0.0 1.0) 0.0) (= (along3 w123x 0.0 1.0) 0.0))))
(check-sat)
(pop)

; Point "one mirror": f = 1/2 at (-3 sqrt2/16, -sqrt6/16, sqrt58/8). Triple 124 passes beside the healthy 234, no other.
(declare-const r58 Real)
(assert (and (> r58 0) (= (* r58 r58) 58.0)))
; expect: sat
(push)
(assert (and (= f 0.5) (= x (* (- (/ 3.0 16.0)) r2)) (= y (* (- (/ 1.0 16.0)) r6)) (= z (* (/ 1.0 8.0) r58))))
(assert (and pass124 (not pass134) (not pass123)))
(check-sat)
(pop)

; Point "two mirrors": f = 1/2 at (-sqrt2/4, 0, sqrt14/4). Triples 124 and 134 pass, 123 does not.
(declare-const r14 Real)
(assert (and (> r14 0) (= (* r14 r14) 14.0)))
; expect: sat
(push)
(assert (and (= f 0.5) (= x (* (- (/ 1.0 4.0)) r2)) (= y 0.0) (= z (* (/ 1.0 4.0) r14))))
(assert (and pass124 pass134 (not pass123)))
(check-sat)
(pop)

; Point "all pass": f = -4/3 with the faulty axis vertical, g = h1 = (2 sqrt2/3, 0, 1/3): its reading 1 becomes -1/3.
; expect: sat
(push)
(assert (and (= f (- (/ 4.0 3.0))) (= x (* (/ 2.0 3.0) r2)) (= y 0.0) (= z (/ 1.0 3.0))))
(assert (and pass124 pass134 pass123))
(check-sat)
(pop)

; ... and that is the only direction, up to sign, in which all four triples pass with a fault on sensor 1.
; expect: unsat
(push)
(assert (and (not (= f 0.0)) pass124 pass134 pass123))
(assert (not (and (= y 0.0) (= x (* 2.0 r2 z)))))
(check-sat)
(pop)

; Point "vertical tool": f = -4/3 at (0, 0, 1): sensor 1 stuck at -1 g where 1/3 g is due. Triple 123 passes, the others not.
; expect: sat
(push)
(assert (and (= f (- (/ 4.0 3.0))) (= x 0.0) (= y 0.0) (= z 1.0)))
(assert (and pass123 (not pass124) (not pass134)))
(check-sat)
(pop)

; Point "clear": f = 1/2 at (0, 0, 1). No faulty triple passes: one attitude is enough.
; expect: sat
(push)
(assert (and (= f 0.5) (= x 0.0) (= y 0.0) (= z 1.0)))
(assert (and (not pass123) (not pass124) (not pass134)))
(check-sat)
(pop)

; A fault beyond 2/|w| = sqrt(8/3) g has no mirror at any attitude (T8, attitude-free) ...
; expect: unsat
(push)
(assert (> (* f f) (/ 8.0 3.0)))
(assert (or pass123 pass124 pass134))
(check-sat)
(pop)
; ... and just at that size it has one.
; expect: sat
(push)
(assert (= (* f f) (/ 8.0 3.0)))
(assert pass124)
(check-sat)
(pop)
