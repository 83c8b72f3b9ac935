; T16 of docs/theory.md for three axes at right angles, for every gravity vector of length 1, every direction of the field and
; every fault: which faults the length of gravity and its part along the field both miss; and two sensors that look alike.
; Each query states its expected answer. tests/detection/dip_evidence_test.cpp puts the like to the code.
; Verifies: REQ-221
(set-logic QF_NRA)
(declare-const x Real)
(declare-const y Real)
(declare-const z Real)
(declare-const p Real)
(declare-const q Real)
(declare-const r Real)
(declare-const f Real)
(assert (= (+ (* x x) (* y y) (* z z)) 1.0))
(assert (= (+ (* p p) (* q q) (* r r)) 1.0))
(define-fun along () Real (+ (* x p) (* y q) (* z r)))

; A fault of sensor 1 that both miss, though the field has a part along axis 1: there is none.
; expect: unsat
(push)
(assert (not (= f 0.0)))
(assert (not (= p 0.0)))
(assert (= (+ (* (+ x f) (+ x f)) (* y y) (* z z)) 1.0))
(assert (= (+ (* (+ x f) p) (* y q) (* z r)) along))
(check-sat)
(pop)

; Where it has none, there is: the mirror of half a g.
; expect: sat
(push)
(assert (= f 0.5))
(assert (= p 0.0))
(assert (= (+ (* (+ x f) (+ x f)) (* y y) (* z z)) 1.0))
(assert (= (+ (* (+ x f) p) (* y q) (* z r)) along))
(check-sat)
(pop)

; Two explanations at one point: gravity along axis 1 with sensor 1 faulty, and its mirror in the plane of the field and axis 3
; with sensor 2 faulty, are as long, as far along the field, and give the same readings. (That there are no others, Coq
; proves: T16_two_explanations.)
(declare-const u Real)
(declare-const v Real)
; expect: sat
(push)
(assert (and (= x 1.0) (= y 0.0) (= z 0.0) (= p 0.6) (= q 0.8) (= r 0.0) (= u (- 0.28)) (= v 0.96)))
(assert (= (+ (* u u) (* v v) (* z z)) 1.0))
(assert (= (+ (* u p) (* v q) (* z r)) along))
(check-sat)
(pop)
