; Facts about the paper's four axes (eq 16), for every gravity vector and every fault, decided by z3 over
; the reals with sqrt(2) and sqrt(6) as exact algebraic numbers. Each query is asked in the negative:
; "unsat" means that no counter-example exists. Sensor i reads h_i . g.
; Verifies: REQ-052
(set-logic QF_NRA)
(declare-const r2 Real)
(declare-const r6 Real)
(assert (and (> r2 0) (= (* r2 r2) 2.0) (> r6 0) (= (* r6 r6) 6.0)))
(declare-const x Real)
(declare-const y Real)
(declare-const z Real)
(define-fun y1 () Real (+ (* (/ 2.0 3.0) r2 x) (* (/ 1.0 3.0) z)))
(define-fun y2 () Real (+ (* (- (/ 1.0 3.0)) r2 x) (* (/ 1.0 3.0) r6 y) (* (/ 1.0 3.0) z)))
(define-fun y3 () Real (+ (* (- (/ 1.0 3.0)) r2 x) (* (- (/ 1.0 3.0)) r6 y) (* (/ 1.0 3.0) z)))
(define-fun y4 () Real z)
(define-fun gg () Real (+ (* x x) (* y y) (* z z)))

; Tight frame: y1^2 + y2^2 + y3^2 + y4^2 = 4/3 |g|^2, so the noise of the estimate has no direction.
; expect: unsat
(push)
(assert (not (= (+ (* y1 y1) (* y2 y2) (* y3 y3) (* y4 y4)) (* (/ 4.0 3.0) gg))))
(check-sat)
(pop)

; Parity: y1 + y2 + y3 - y4 = 0 for every g. A single fault therefore shows in it at every attitude.
; expect: unsat
(push)
(assert (not (= (+ y1 y2 y3 (- y4)) 0.0)))
(check-sat)
(pop)

; Mirror (theorem T1) for the triple 1, 2, 4 of eq (20) with a fault f on sensor 1: its length is kept only
; for f = 0 and for f = -(4/3) g.w, w = (3 sqrt2/4, sqrt6/4, 0), |w|^2 = 3/2.
(declare-const f Real)
(define-fun wx () Real (* (/ 3.0 4.0) r2))
(define-fun wy () Real (* (/ 1.0 4.0) r6))
(define-fun gw () Real (+ (* x wx) (* y wy)))
(define-fun lx () Real (+ x (* f wx)))
(define-fun ly () Real (+ y (* f wy)))
; expect: unsat
(push)
(assert (not (= (+ (* wx wx) (* wy wy)) (/ 3.0 2.0))))
(check-sat)
(pop)
; expect: unsat
(push)
(assert (= (+ (* lx lx) (* ly ly) (* z z)) gg))
(assert (not (= f 0.0)))
(assert (not (= f (* (- (/ 4.0 3.0)) gw))))
(check-sat)
(pop)

; ... and such mirrors are real: a bias of half a g is invisible to that triple at some attitude. (A query
; that must be satisfiable guards the others against a contradictory preamble.)
; expect: sat
(push)
(assert (= gg 1.0))
(assert (= f 0.5))
(assert (= (+ (* lx lx) (* ly ly) (* z z)) gg))
(check-sat)
(pop)

; But the parity row sees it there as everywhere: y1 + f enters with weight 1.
; expect: unsat
(push)
(assert (= f 0.5))
(assert (= (+ y1 f y2 y3 (- y4)) 0.0))
(check-sat)
(pop)
